"""A sign-in service on loopback: a real one over HTTP, that can be told to lie."""

import base64
import hashlib
import json
import secrets
import threading
import time
import urllib.parse
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import jwt
from cryptography.hazmat.primitives.asymmetric import ec

CLIENT, SECRET = "ambula", "a client's secret: with signs/+"


class SignInService:
    """Grants codes, exchanges each once against PKCE and the client's secret, and signs tokens with ES256."""

    def __init__(self):
        self.key, self.key_id = ec.generate_private_key(ec.SECP256R1()), "first"
        self.person = {"sub": "248289761001", "email": "m.arnold@clinic.example", "email_verified": True}
        self.claims = {}
        self.answers = {}
        self.asked = []
        self._codes = {}
        self._server = ThreadingHTTPServer(("127.0.0.1", 0), self._handler())
        self.issuer = f"http://127.0.0.1:{self._server.server_port}"
        threading.Thread(target=self._server.serve_forever, kwargs={"poll_interval": 0.05}, daemon=True).start()

    def close(self):
        self._server.shutdown()
        self._server.server_close()

    def discovery(self):
        return {
            "issuer": self.issuer,
            "authorization_endpoint": f"{self.issuer}/authorize",
            "token_endpoint": f"{self.issuer}/token",
            "jwks_uri": f"{self.issuer}/keys",
        }

    def keys(self):
        public = json.loads(jwt.algorithms.ECAlgorithm.to_jwk(self.key.public_key()))
        return {"keys": [public | {"kid": self.key_id, "use": "sig", "alg": "ES256"}]}

    def authorize(self, asked):
        """Where the browser is sent back to, as somebody who gave their password just now."""
        code = secrets.token_urlsafe(8)
        self._codes[code] = asked | {"at": int(time.time())}
        back = {"code": code, "state": asked["state"], "iss": self.issuer}
        return f"{asked['redirect_uri']}?{urllib.parse.urlencode(back)}"

    def exchange(self, form, authorization):
        """The token response, or None for a request that a service would refuse."""
        name, _, secret = base64.b64decode(authorization.removeprefix("Basic ")).decode().partition(":")
        granted = self._codes.pop(form.get("code", ""), None)
        if granted is None or (urllib.parse.unquote(name), urllib.parse.unquote(secret)) != (CLIENT, SECRET):
            return None
        digest = hashlib.sha256(form["code_verifier"].encode()).digest()
        if base64.urlsafe_b64encode(digest).decode().rstrip("=") != granted["code_challenge"]:
            return None
        if form["redirect_uri"] != granted["redirect_uri"]:
            return None
        return {"access_token": "unused", "token_type": "Bearer", "id_token": self.token(granted)}

    def token(self, granted):
        now = int(time.time())
        claims = {
            "iss": self.issuer, "aud": CLIENT, "iat": now, "exp": now + 60, "nonce": granted["nonce"],
            "auth_time": granted["at"],
        }  # fmt: skip
        claims = {name: value for name, value in (claims | self.person | self.claims).items() if value is not None}
        return self.sign(claims)

    def sign(self, claims):
        return jwt.encode(claims, self.key, "ES256", {"kid": self.key_id})

    def answer(self, path, form, authorization):
        self.asked.append(path)
        if path in self.answers:
            return self.answers[path]
        if path == "/token":
            return self.exchange(form, authorization)
        return {"/.well-known/openid-configuration": self.discovery, "/keys": self.keys}[path]()

    def _handler(service):  # noqa: N805 - the handler's own self is another one
        class Handler(BaseHTTPRequestHandler):
            def do_GET(self):
                self._say(service.answer(self.path, {}, ""))

            def do_POST(self):
                text = self.rfile.read(int(self.headers["content-length"])).decode()
                self._say(service.answer(self.path, dict(urllib.parse.parse_qsl(text)), self.headers["authorization"]))

            def _say(self, document):
                self.send_response(400 if document is None else 302 if isinstance(document, str) else 200)
                if isinstance(document, str):
                    self.send_header("Location", document)
                self.end_headers()
                self.wfile.write(document if isinstance(document, bytes) else json.dumps(document).encode())

            def log_message(self, *_):
                pass

        return Handler
