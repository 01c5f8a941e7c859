"""What axe-core says about the page that is open."""

from selenium.webdriver import Chrome

from services.gateway.settings import DIST

SOURCE = DIST.parents[1] / "web" / "node_modules" / "axe-core" / "axe.min.js"

ASK = """
const done = arguments[arguments.length - 1];
axe.run(document, { resultTypes: ["violations"] }).then(({ violations }) => done(violations.map(
  ({ id, help, nodes }) => `${id}: ${help}: ${nodes.slice(0, 3).map((node) => node.html.slice(0, 200)).join(" | ")}`
)));
"""


def violations(page: Chrome) -> list[str]:
    """Each rule that is broken, and where. Scripts of the browser's driver are not subject to the page's policy."""
    if not page.execute_script("return 'axe' in window"):
        page.execute_script(SOURCE.read_text(encoding="utf-8"))
    found: list[str] = page.execute_async_script(ASK)
    return found
