"""Charts as stand-alone SVG, the same on a web page and on paper."""
