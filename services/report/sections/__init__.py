"""The sections of a report, one module each: values in, a section or None out."""
