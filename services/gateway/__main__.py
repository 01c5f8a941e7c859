"""`python -m services.gateway`: the web server of one site."""

import sys

from services.gateway.serve import serve

if __name__ == "__main__":
    sys.exit(serve())
