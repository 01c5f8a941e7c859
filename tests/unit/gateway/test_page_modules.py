"""The page's pure modules, by node's own test runner; and whether its colours can be read."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest

from services.gateway.settings import DIST

HERE = Path(__file__).parent
STYLES = DIST.parents[1] / "web" / "src" / "styles"
PALETTE = DIST.parents[1] / "web" / "src" / "palette.js"


def read_styles():
    return "\n".join(file.read_text() for file in sorted(STYLES.glob("*.css")))


def test_every_style_is_in_the_one_list():
    listed = re.findall(r'"\./styles/([^"]+)"', STYLES.with_name("style.css").read_text())
    assert sorted(listed) == sorted(file.name for file in STYLES.glob("*.css"))


@pytest.mark.skipif(shutil.which("node") is None, reason="node is not installed")
@pytest.mark.parametrize(
    "name", ["page", "live_pages", "whole_body", "walking_tests", "progress", "replay_pages", "page_table"]
)
def test_page_modules(name):
    done = subprocess.run(
        ["node", "--test", str(HERE / f"{name}.test.mjs")], capture_output=True, text=True, timeout=120, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr


def luminance(colour: str) -> float:
    """Relative luminance of `#rrggbb` (WCAG 2.2)."""
    channels = [int(colour[place : place + 2], 16) / 255 for place in (1, 3, 5)]
    linear = [value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4 for value in channels]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one: str, other: str) -> float:
    bright, dark = sorted((luminance(one), luminance(other)), reverse=True)
    return (bright + 0.05) / (dark + 0.05)


def test_the_ratio_is_that_of_the_recommendation():
    assert contrast("#000000", "#ffffff") == pytest.approx(21)
    assert contrast("#C44E00", "#ffffff") == pytest.approx(4.73, abs=0.01)
    assert contrast("#0072B2", "#ffffff") == pytest.approx(5.19, abs=0.01)


PAIRS = [
    *((text, ground) for text in ("ink", "soft", "accent") for ground in ("panel", "ground")),
    *((side, "panel") for side in ("left", "right")),
    *((tone, f"{tone}-ground") for tone in ("good", "wait", "check", "lost")),
    *((tone, "panel") for tone in ("good", "wait", "check", "lost")),
]


@pytest.mark.parametrize(("text", "ground"), PAIRS)
def test_text_can_be_read(text, ground):
    colours = dict(re.findall(r"--([a-z-]+): (#[0-9a-f]{6});", read_styles()))
    assert contrast(colours[text], colours[ground]) >= 4.5


def test_grey_numbers_can_still_be_read():
    [grey] = re.findall(r"color: (#[0-9a-f]{6}) !important", read_styles())
    assert contrast(grey, "#ffffff") >= 4.5


def test_sides_have_the_colours_of_the_convention_and_do_not_rest_on_colour():
    text = PALETTE.read_text()
    assert 'LEFT = "#C44E00"' in text
    assert 'RIGHT = "#0072B2"' in text
    assert re.search(r"SIDE_DASH = \{ left: undefined, right: \[", text)
