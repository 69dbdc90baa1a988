#!/usr/bin/env python3
"""A learning platform for tests: LTI 1.3 Core, the Security Framework 1.0 and Assignment and Grade Services 2.0, as the standards' texts have them.

It is strict: what a standard says MUST or SHOULD be is required, and whatever is not so is refused and kept in `violations`. On request it
attacks: /auth answers with a token that is spoilt as `lti_message_hint` says. `/control` tells a test what came, and takes what shall be.
"""
import argparse
import base64
import datetime
import hashlib
import hmac
import http.server
import json
import re
import secrets
import ssl
import threading
import time
import urllib.parse
import urllib.request

from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import padding, rsa

CLAIM = "https://purl.imsglobal.org/spec/lti/claim/"
AGS = "https://purl.imsglobal.org/spec/lti-ags/"
ROLE = "http://purl.imsglobal.org/vocab/lis/v2/membership#"
ITEM = "application/vnd.ims.lis.v2.lineitem+json"
ITEMS = "application/vnd.ims.lis.v2.lineitemcontainer+json"
SCORE = "application/vnd.ims.lis.v1.score+json"
CLIENT, DEPLOYMENT = "cavum-1", "1"


def b64(data: bytes) -> str:
    return base64.urlsafe_b64encode(data).rstrip(b"=").decode()


def unb64(text: str) -> bytes:
    if not re.fullmatch(r"[A-Za-z0-9_-]*", text):
        raise ValueError("no base64url")
    return base64.urlsafe_b64decode(text + "=" * (-len(text) % 4))


def number(n: int) -> str:
    return b64(n.to_bytes((n.bit_length() + 7) // 8, "big"))


def jwk(key: rsa.RSAPublicKey, kid: str) -> dict:
    n = key.public_numbers()
    return {"kty": "RSA", "alg": "RS256", "use": "sig", "kid": kid, "n": number(n.n), "e": number(n.e)}


def rs256(key: rsa.RSAPrivateKey, text: str) -> bytes:
    return key.sign(text.encode(), padding.PKCS1v15(), hashes.SHA256())


KEY = rsa.generate_private_key(public_exponent=65537, key_size=2048)
OTHER = rsa.generate_private_key(public_exponent=65537, key_size=2048)
SMALL = rsa.generate_private_key(public_exponent=65537, key_size=1024)


class Refused(Exception):
    def __init__(self, status: int, why: str):
        super().__init__(why)
        self.status = status


class Platform:
    def __init__(self, tool: str):
        self.tool, self.issuer = tool, ""
        self.lock = threading.Lock()
        self.nonces, self.jtis, self.tokens = set(), set(), {}
        self.items, self.results, self.posts, self.violations = [], {}, [], []
        self.asked = {}
        self.now = {"down": "", "coupled": False, "exam": "block_cavity", "jwks": "", "lineitems": "", "roster": ["u-4711", "u-4712", "u-4713"], "page": 2, "token_s": 3600}

    # the login and its token

    def auth(self, q: dict) -> tuple[dict, str]:
        for name, value in {"scope": "openid", "response_type": "id_token", "response_mode": "form_post", "prompt": "none", "client_id": CLIENT,
                            "redirect_uri": self.tool + "/lti/launch"}.items():
            if q.get(name) != value:
                raise Refused(400, f"{name} is {q.get(name)!r}")
        for name in ("login_hint", "state", "nonce"):
            if not q.get(name):
                raise Refused(400, f"no {name}")
        if q["nonce"] in self.nonces:
            raise Refused(400, "a nonce twice")
        self.nonces.add(q["nonce"])
        role, who = q["login_hint"].split(":")
        return self.spoilt(self.claims(role, who, q["nonce"]), q.get("lti_message_hint", "")), q["state"]

    def claims(self, role: str, who: str, nonce: str) -> dict:
        now = int(time.time())
        grades = {"scope": [AGS + "scope/lineitem", AGS + "scope/score"], "lineitems": self.now["lineitems"] or self.issuer + "/course/7/lineitems?type=1"}
        if self.now["coupled"]:
            if not any(i["resourceLinkId"] == "link-1" for i in self.items if "resourceLinkId" in i):
                self.items.append({"id": self.issuer + "/course/7/lineitems/99?type=1", "label": "the link's own", "scoreMaximum": 100, "resourceLinkId": "link-1"})
            grades["lineitem"] = self.issuer + "/course/7/lineitems/99?type=1"
        custom = {"number": who} if who else {}
        if self.now["exam"]:
            custom["exam"] = self.now["exam"]
        return {"iss": self.issuer, "aud": CLIENT, "sub": "u-" + who, "iat": now, "exp": now + 300, "nonce": nonce, "name": "Name of " + who,
                CLAIM + "deployment_id": DEPLOYMENT, CLAIM + "message_type": "LtiResourceLinkRequest", CLAIM + "version": "1.3.0",
                CLAIM + "target_link_uri": self.tool + "/lti/launch", CLAIM + "resource_link": {"id": "link-1", "title": "the exam"},
                CLAIM + "roles": [ROLE + role], CLAIM + "context": {"id": "course-7", "title": "Operative dentistry"},
                CLAIM + "custom": custom, AGS + "claim/endpoint": grades}

    def spoilt(self, c: dict, how: str) -> str:
        head, key, sign = {"alg": "RS256", "kid": "k1", "typ": "JWT"}, KEY, rs256
        if how == "alg_none":
            head, sign = {"alg": "none", "kid": "k1"}, lambda k, t: b""
        elif how == "alg_none_capitals":
            head, sign = {"alg": "NoNe", "kid": "k1"}, lambda k, t: b""
        elif how in ("hs256", "hs256_der"):
            form = (serialization.Encoding.PEM if how == "hs256" else serialization.Encoding.DER)
            public = KEY.public_key().public_bytes(form, serialization.PublicFormat.SubjectPublicKeyInfo)
            head["alg"], sign = "HS256", lambda k, t: hmac.new(public, t.encode(), hashlib.sha256).digest()
        elif how == "rs384":
            head["alg"], sign = "RS384", lambda k, t: k.sign(t.encode(), padding.PKCS1v15(), hashes.SHA384())
        elif how == "pss_as_rs256":
            sign = lambda k, t: k.sign(t.encode(), padding.PSS(padding.MGF1(hashes.SHA256()), 32), hashes.SHA256())
        elif how == "other_kid":
            head["kid"], key = "k2", OTHER
        elif how == "no_kid":
            del head["kid"]
        elif how == "other_key":
            key = OTHER
        elif how == "small_key":
            head["kid"], key = "small", SMALL
        elif how == "own_jwk":
            head["jwk"], key = jwk(OTHER.public_key(), "k1"), OTHER
        elif how == "own_jku":
            head["jku"], head["kid"], key = self.issuer + "/elsewhere", "k2", OTHER
        elif how == "crit":
            head["crit"] = ["exp"]
        elif how == "expired":
            c["iat"], c["exp"] = c["iat"] - 400, c["exp"] - 400
        elif how == "no_exp":
            del c["exp"]
        elif how == "exp_text":
            c["exp"] = str(c["exp"])
        elif how == "future":
            c["iat"], c["exp"] = c["iat"] + 400, c["exp"] + 400
        elif how == "old":
            c["iat"] -= 4000
        elif how == "aud_other":
            c["aud"] = "another-tool"
        elif how == "aud_two":
            c["aud"], c["azp"] = [CLIENT, "another-tool"], CLIENT
        elif how == "aud_list":
            c["aud"], c["azp"] = [CLIENT], CLIENT  # this one is right
        elif how == "azp_other":
            c["azp"] = "another-tool"
        elif how == "iss_other":
            c["iss"] = "https://elsewhere.example"
        elif how == "nonce_other":
            c["nonce"] = secrets.token_hex(32)
        elif how == "no_nonce":
            del c["nonce"]
        elif how == "deployment_other":
            c[CLAIM + "deployment_id"] = "2"
        elif how == "type_other":
            c[CLAIM + "message_type"] = "LtiDeepLinkingRequest"
        elif how == "version_other":
            c[CLAIM + "version"] = "1.1"
        elif how == "target_other":
            c[CLAIM + "target_link_uri"] = "https://elsewhere.example/"
        elif how == "no_link":
            del c[CLAIM + "resource_link"]
        elif how == "no_sub":
            del c["sub"]
        elif how == "no_roles":
            del c[CLAIM + "roles"]
        elif how == "role_other":
            c[CLAIM + "roles"] = ["http://purl.imsglobal.org/vocab/lis/v2/institution/person#Administrator", "Instructor"]
        elif how != "" and how not in ("changed", "twice", "cut"):
            raise Refused(500, "no such attack")
        payload = json.dumps(c)
        if how == "twice":
            payload = payload[:-1] + ', "sub": "u-4712"}'
        text = b64(json.dumps(head).encode()) + "." + b64(payload.encode())
        signature = sign(key, text)
        if how == "changed":
            c[CLAIM + "custom"]["number"], c["sub"] = "4712", "u-4712"
            text = text.split(".")[0] + "." + b64(json.dumps(c).encode())
        if how == "cut":
            signature = signature[:-1]
        return text + "." + b64(signature)

    # services

    def tools_key(self, kid: str) -> rsa.RSAPublicKey:
        context = ssl.create_default_context()
        context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
        with urllib.request.urlopen(self.tool + "/lti/jwks", context=context, timeout=20) as reply:
            keys = json.load(reply)["keys"]
        found = [k for k in keys if k["kid"] == kid]
        if len(found) != 1 or found[0]["kty"] != "RSA" or found[0].get("alg") != "RS256" or {"d", "p", "q"} & set(found[0]):
            raise Refused(400, "no such key of the tool's")
        value = lambda name: int.from_bytes(unb64(found[0][name]), "big")
        return rsa.RSAPublicNumbers(value("e"), value("n")).public_key()

    def token(self, form: dict) -> dict:
        if form.get("grant_type") != "client_credentials" or form.get("client_assertion_type") != "urn:ietf:params:oauth:client-assertion-type:jwt-bearer":
            raise Refused(400, "unsupported_grant_type")
        head, payload, signature = form["client_assertion"].split(".")
        header, c = json.loads(unb64(head)), json.loads(unb64(payload))
        if header.get("alg") != "RS256":
            raise Refused(400, "the assertion is not signed by RS256")
        try:
            self.tools_key(header["kid"]).verify(unb64(signature), f"{head}.{payload}".encode(), padding.PKCS1v15(), hashes.SHA256())
        except Refused:
            raise
        except Exception as wrong:
            raise Refused(400, "the assertion's signature does not hold") from wrong
        now = time.time()
        if c.get("iss") != CLIENT or c.get("sub") != CLIENT or c.get("aud") != self.issuer + "/token":
            raise Refused(400, "the assertion is another's, or for another")
        if not (isinstance(c.get("iat"), int) and isinstance(c.get("exp"), int) and c["iat"] <= now + 5 and now < c["exp"] <= c["iat"] + 3600):
            raise Refused(400, "the assertion's times are wrong")
        if not c.get("jti") or c["jti"] in self.jtis:
            raise Refused(400, "an assertion twice")
        self.jtis.add(c["jti"])
        scopes = form.get("scope", "").split()
        if not scopes or not set(scopes) <= {AGS + "scope/lineitem", AGS + "scope/score"}:
            raise Refused(400, "invalid_scope")
        token = secrets.token_urlsafe(24)
        self.tokens[token] = (set(scopes), now + self.now["token_s"])
        return {"access_token": token, "token_type": "Bearer", "expires_in": self.now["token_s"], "scope": " ".join(scopes)}

    def require(self, fields, scope: str) -> None:
        kind, _, token = (fields.get("Authorization") or "").partition(" ")
        scopes, until = self.tokens.get(token, (set(), 0))
        if kind != "Bearer" or time.time() > until:
            raise Refused(401, "no token")
        if AGS + "scope/" + scope not in scopes:
            raise Refused(403, "the token is for something else")

    def list_items(self, fields, query: dict) -> tuple[list, str]:
        self.require(fields, "lineitem")
        if ITEMS not in (fields.get("Accept") or ""):
            raise Refused(406, "Accept is not the container's type")
        if query.get("type") != "1":
            raise Refused(404, "the address lost its query")
        found = [i for i in self.items if all(i.get(name) == query[q] for q, name in (("resource_id", "resourceId"), ("tag", "tag")) if q in query)]
        begin, size = int(query.get("from", 0)), self.now["page"]
        more = ""
        if begin + size < len(found):
            more = self.issuer + "/course/7/lineitems?" + urllib.parse.urlencode({**query, "from": begin + size})
        return found[begin:begin + size], more

    def make_item(self, fields, body: bytes) -> dict:
        self.require(fields, "lineitem")
        if fields.get("Content-Type") != ITEM:
            raise Refused(415, "Content-Type is not a line item's")
        item = json.loads(body)
        if not str(item.get("label", "")).strip() or not isinstance(item.get("scoreMaximum"), (int, float)) or item["scoreMaximum"] <= 0 or "id" in item:
            raise Refused(400, "no line item")
        item["id"] = f"{self.issuer}/course/7/lineitems/{len(self.items) + 1}?type=1"
        self.items.append(item)
        return item

    def score(self, fields, path: str, body: bytes) -> None:
        self.require(fields, "score")
        if fields.get("Content-Type") != SCORE:
            raise Refused(415, "Content-Type is not a score's")
        item = next((i for i in self.items if urllib.parse.urlsplit(i["id"]).path + "/scores" == path), None)
        if item is None:
            raise Refused(404, "no such line item")
        s = json.loads(body)
        self.posts.append({"item": item["id"], **s})
        if not isinstance(s.get("userId"), str):
            raise Refused(400, "no userId")
        if s.get("activityProgress") not in ("Initialized", "Started", "InProgress", "Submitted", "Completed"):
            raise Refused(400, "no activityProgress")
        if s.get("gradingProgress") not in ("FullyGraded", "Pending", "PendingManual", "Failed", "NotReady"):
            raise Refused(400, "no gradingProgress")
        if not re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d+(Z|[+-]\d\d:\d\d)", str(s.get("timestamp"))):
            raise Refused(400, "timestamp is not ISO 8601 with a zone and parts of a second")
        at = datetime.datetime.fromisoformat(s["timestamp"].replace("Z", "+00:00"))
        given, most = s.get("scoreGiven"), s.get("scoreMaximum")
        if given is not None and (isinstance(given, bool) or not isinstance(given, (int, float)) or given < 0 or not isinstance(most, (int, float)) or most <= 0):
            raise Refused(400, "scoreGiven and scoreMaximum do not go together")
        if s["userId"] not in self.now["roster"]:
            raise Refused(404, "nobody of that name is in this course")
        before = self.results.get((item["id"], s["userId"]))
        if before is not None and at <= before["at"]:
            raise Refused(409, "a later score is there")
        # without scoreGiven the score that was there goes
        self.results[item["id"], s["userId"]] = {"at": at, "score": None if given is None else given / most * item["scoreMaximum"],
                                                 "progress": s["gradingProgress"], "comment": s.get("comment", "")}


class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    platform: Platform

    def log_message(self, *_):
        pass

    def reply(self, status: int, body: bytes = b"", kind: str = "application/json", fields: dict | None = None) -> None:
        self.send_response(status)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(body)))
        for name, value in (fields or {}).items():
            self.send_header(name, value)
        try:
            self.end_headers()
            self.wfile.write(body)
        except OSError:  # who asked has hung up
            self.close_connection = True

    def handle_any(self) -> None:
        p = self.platform
        parts = urllib.parse.urlsplit(self.path)
        query = dict(urllib.parse.parse_qsl(parts.query, keep_blank_values=True))
        body = self.rfile.read(int(self.headers.get("Content-Length") or 0))
        if parts.path == "/control":
            with p.lock:
                if body.strip() not in (b"", b"{}"):
                    p.now.update(json.loads(body))
                    if "posts" in p.now:  # forget what came
                        p.posts, p.asked = [], {}
                        del p.now["posts"]
                    if "tokens" in p.now:  # all tokens end before their time
                        p.tokens = {}
                        del p.now["tokens"]
                state = {"posts": p.posts, "violations": p.violations, "items": p.items, "asked": p.asked,
                         "results": {who: {k: v for k, v in r.items() if k != "at"} for (_, who), r in p.results.items()}}
            return self.reply(200, json.dumps(state).encode())
        p.asked[parts.path] = p.asked.get(parts.path, 0) + 1
        if p.now["down"] == "silent":
            self.close_connection = True
            return None
        if p.now["down"] == "503":
            return self.reply(503)
        try:
            return self.answer(p, parts.path, query, body)
        except Refused as refused:
            if refused.status not in (401, 404, 409) or parts.path == "/token":
                p.violations.append(f"{self.command} {parts.path}: {refused}")
            return self.reply(refused.status, json.dumps({"error": str(refused)}).encode())
        except OSError:  # the office has hung up
            self.close_connection = True
        except Exception as wrong:  # what it sent cannot even be read
            p.violations.append(f"{self.command} {parts.path}: {type(wrong).__name__} {wrong}")
            return self.reply(400)

    def answer(self, p: Platform, path: str, query: dict, body: bytes) -> None:
        if path == "/jwks":
            if p.now["jwks"] == "redirect":
                return self.reply(302, fields={"Location": p.issuer + "/elsewhere"})
            if p.now["jwks"] == "endless":
                return self.reply(200, b'{"keys":[' + b" " * (4 << 20) + b"]}")
            return self.reply(200, json.dumps({"keys": [jwk(KEY.public_key(), "k1"), jwk(SMALL.public_key(), "small")]}).encode())
        if path == "/auth":
            with p.lock:
                token, state = p.auth(query)
            page = f'<form method="post" action="{p.tool}/lti/launch"><input name="state" value="{state}"><input name="id_token" value="{token}"></form><script>document.forms[0].submit()</script>'
            return self.reply(200, page.encode(), "text/html")
        if path == "/course":  # as a learner or teacher sees it: a link to the tool, or the tool in a frame of the page
            login = urllib.parse.urlencode({"iss": p.issuer, "login_hint": query["as"], "target_link_uri": p.tool + "/lti/launch",
                                            "client_id": CLIENT, "lti_deployment_id": DEPLOYMENT})
            to = f'{p.tool}/lti/login?{login}'.replace("&", "&amp;")
            shown = f'<iframe title="the exam" width="800" height="500" src="{to}"></iframe>' if "framed" in query else f'<a href="{to}">the exam</a>'
            return self.reply(200, f'<!doctype html><html lang="en"><title>Operative dentistry</title><h1>Operative dentistry</h1>{shown}</html>'.encode(), "text/html")
        if path == "/token" and self.command == "POST":
            if self.headers.get("Content-Type") != "application/x-www-form-urlencoded":
                raise Refused(400, "no form")
            token = p.token(dict(urllib.parse.parse_qsl(body.decode(), keep_blank_values=True)))
            return self.reply(200, json.dumps(token).encode())
        with p.lock:
            if path == "/course/7/lineitems" and self.command == "GET":
                items, more = p.list_items(self.headers, query)
                return self.reply(200, json.dumps(items).encode(), ITEMS, {"Link": f'<{more}>; rel="next"'} if more else {})
            if path == "/course/7/lineitems" and self.command == "POST":
                return self.reply(201, json.dumps(p.make_item(self.headers, body)).encode(), ITEM)
            if path.endswith("/scores") and self.command == "POST":
                p.score(self.headers, path, body)
                return self.reply(204 if len(p.posts) % 2 else 200)
        raise Refused(404, "nothing is here")

    do_GET = do_POST = do_PUT = do_DELETE = handle_any


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__)
    for name in ("--certificate", "--key", "--tool"):
        options.add_argument(name, required=True)
    options.add_argument("--port", type=int, default=0)
    options.add_argument("--name", default="127.0.0.1", help="by which browsers and the office reach it")
    given = options.parse_args()
    Handler.platform = Platform(given.tool)
    server = http.server.ThreadingHTTPServer(("127.0.0.1", given.port), Handler)
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(given.certificate, given.key)
    server.socket = context.wrap_socket(server.socket, server_side=True)
    Handler.platform.issuer = f"https://{given.name}:{server.server_address[1]}"
    print(server.server_address[1], flush=True)
    server.serve_forever()


if __name__ == "__main__":
    main()
