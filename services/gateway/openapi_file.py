"""Write the published description of the API: `python -m services.gateway.openapi_file`."""

import json
import tempfile
from pathlib import Path
from typing import Any

from services.gateway.app import create_app
from services.gateway.bus_control import BusControl
from services.gateway.bus_feed import BusLink
from services.gateway.live.hub import LiveHub
from services.gateway.settings import GatewaySettings

FILE = Path(__file__).parent / "openapi.json"


def document() -> dict[str, Any]:
    """The OpenAPI document of the code."""
    with tempfile.TemporaryDirectory() as folder:
        app = create_app(GatewaySettings(data_dir=Path(folder), database=""), LiveHub(), BusControl(BusLink()))
        app.state.gateway.database.close()
        return app.openapi()


if __name__ == "__main__":
    FILE.write_text(json.dumps(document(), indent=1) + "\n")
