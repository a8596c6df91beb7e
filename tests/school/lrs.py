#!/usr/bin/env python3
"""A strict learning record store (xAPI 1.0.3) for tests, which can be told to misbehave. Python's library alone.

    tests/school/lrs.py [--port 0] [--key KEY:SECRET] [--file lrs.sqlite]      prints its address

    with Lrs() as lrs: lrs.endpoint, lrs.key, lrs.statements(), lrs.faults.append({"status": 500})

Faults are taken one by one by requests that write statements: {"status": S, "retry_after": T, "body": B} instead of doing it;
{"cut": "before"} closes the connection without doing it, "after" does it and then closes, "within" closes in the middle of
the answer; {"slow": S} waits first. docs/teach/xapi.md says how many tests of adlnet's suite it passes.
"""
import argparse
import base64
import datetime
import email.parser
import email.policy
import hashlib
import json
import re
import socket
import sqlite3
import ssl
import sys
import threading
import time
import urllib.parse
import uuid
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

from lrs_rules import LANGUAGE, SIGNATURE, UUID, VOIDED, Wrong, activity, agent, check_signature, check_statement, iri, need, parsed, same
from lrs_rules import time as time_of

FILTERS = {"agent", "verb", "activity", "registration", "related_activities", "related_agents", "since", "until", "limit", "format",
           "attachments", "ascending"}
PAGE = 100  # statements on a page, at most


class Refused(Exception):
    def __init__(self, status, why, **fields):
        super().__init__(why)
        self.status, self.fields = status, fields


def now():
    return datetime.datetime.now(datetime.timezone.utc).replace(tzinfo=None)


def written(at):
    return at.isoformat(timespec="microseconds") + "Z"


def who(value):
    """An agent by its identifier alone."""
    for name in ("mbox", "mbox_sha1sum", "openid"):
        if name in value:
            return f"{name} {value[name]}"
    if "account" in value:
        return f"account {value['account'].get('homePage')} {value['account'].get('name')}"
    return None


def agents_in(statement, related):
    found = []

    def take(value):
        if isinstance(value, dict):
            found.append(who(value))
            if value.get("objectType") == "Group":
                found.extend(who(one) for one in value.get("member", []))
    take(statement["actor"])
    if statement["object"].get("objectType") in ("Agent", "Group"):
        take(statement["object"])
    if related:
        take(statement.get("authority"))
        for part in [statement] + ([statement["object"]] if statement["object"].get("objectType") == "SubStatement" else []):
            take(part.get("actor"))
            if part.get("object", {}).get("objectType") in ("Agent", "Group"):
                take(part["object"])
            for name in ("instructor", "team"):
                take(part.get("context", {}).get(name))
    return set(found) - {None}


def activities_in(statement, related):
    thing = statement["object"]
    found = {thing["id"]} if thing.get("objectType", "Activity") == "Activity" else set()
    if related:
        for part in [statement] + ([thing] if thing.get("objectType") == "SubStatement" else []):
            inner = part.get("object", {})
            if inner.get("objectType", "Activity") == "Activity":
                found.add(inner.get("id"))
            for some in part.get("context", {}).get("contextActivities", {}).values():
                found.update(one["id"] for one in some)
    return found


class Store:
    """Statements and documents. One lock: it is for tests."""

    def __init__(self, file):
        self.lock = threading.RLock()
        self.db = sqlite3.connect(file, check_same_thread=False, isolation_level=None)
        self.db.executescript("""
            CREATE TABLE IF NOT EXISTS statement (n INTEGER PRIMARY KEY, id TEXT UNIQUE, json TEXT, stored TEXT, voided INTEGER DEFAULT 0);
            CREATE TABLE IF NOT EXISTS attachment (sha2 TEXT PRIMARY KEY, type TEXT, data BLOB);
            CREATE TABLE IF NOT EXISTS document (kind TEXT, owner TEXT, id TEXT, type TEXT, data BLOB, updated TEXT, PRIMARY KEY (kind, owner, id));
            CREATE TABLE IF NOT EXISTS activity (id TEXT PRIMARY KEY, definition TEXT);
            """)

    def one(self, identity):
        row = self.db.execute("SELECT json, voided FROM statement WHERE id = ?", (identity.lower(),)).fetchone()
        return (json.loads(row[0]), bool(row[1])) if row else (None, False)

    def put(self, statements, parts):
        with self.lock:
            self.db.execute("BEGIN")
            try:
                for one in statements:
                    self.put_one(one)
                for sha2, (kind, data) in parts.items():
                    self.db.execute("INSERT OR IGNORE INTO attachment VALUES (?, ?, ?)", (sha2, kind, data))
                self.db.execute("COMMIT")
            except Exception:
                self.db.execute("ROLLBACK")
                raise

    def put_one(self, one):
        known, _ = self.one(one["id"])
        if known:
            if not same(known, one):
                raise Refused(409, f"another statement has the id {one['id']}")
            return
        if one["verb"]["id"] == VOIDED:
            target, voided = self.one(one["object"]["id"])
            if target and target["verb"]["id"] == VOIDED:
                raise Refused(400, "a voiding statement cannot be voided")
            self.db.execute("UPDATE statement SET voided = 1 WHERE id = ?", (one["object"]["id"].lower(),))
        late = self.db.execute("SELECT count(*) FROM statement WHERE json LIKE ? AND json LIKE ?",
                               (f"%{VOIDED}%", f'%"StatementRef"%{one["id"]}%')).fetchone()[0]
        self.db.execute("INSERT INTO statement (id, json, stored, voided) VALUES (?, ?, ?, ?)",
                        (one["id"].lower(), json.dumps(one), one["stored"], int(late > 0 and one["verb"]["id"] != VOIDED)))
        self.note_activities(one)

    def note_activities(self, statement):
        def note(thing):
            if thing.get("objectType", "Activity") != "Activity" or "id" not in thing:
                return
            row = self.db.execute("SELECT definition FROM activity WHERE id = ?", (thing["id"],)).fetchone()
            known = json.loads(row[0]) if row else {}
            for name, value in thing.get("definition", {}).items():
                known[name] = {**known.get(name, {}), **value} if name in ("name", "description") else value
            self.db.execute("INSERT OR REPLACE INTO activity VALUES (?, ?)", (thing["id"], json.dumps(known)))
        for part in [statement, statement["object"]]:
            note(part.get("object", {}))
            for some in part.get("context", {}).get("contextActivities", {}).values():
                for one in some:
                    note(one)

    def find(self, query):
        rows = self.db.execute("SELECT n, json, stored, voided FROM statement ORDER BY n").fetchall()
        every = [(n, json.loads(text), stored, voided) for n, text, stored, voided in rows]
        related = [query.get(name) == "true" for name in ("related_agents", "related_activities")]
        wanted = who(json.loads(query["agent"])) if "agent" in query else None

        def matches(one):
            return (("agent" not in query or wanted in agents_in(one, related[0])) and
                    ("verb" not in query or one["verb"]["id"] == query["verb"]) and
                    ("activity" not in query or query["activity"] in activities_in(one, related[1])) and
                    ("registration" not in query or one.get("context", {}).get("registration", "").lower() == query["registration"].lower()))
        targets = {one["id"].lower() for _, one, _, _ in every if matches(one)}
        while True:  # who refers to one that matches, matches too
            more = {one["id"].lower() for _, one, _, _ in every if one["object"].get("objectType") == "StatementRef" and
                    one["object"]["id"].lower() in targets} - targets
            if not more:
                break
            targets |= more
        since, until = (time_of(query[name]) if name in query else None for name in ("since", "until"))
        found = [(n, one) for n, one, stored, voided in every if not voided and one["id"].lower() in targets and
                 (since is None or time_of(stored) > since) and (until is None or time_of(stored) <= until)]
        return found if query.get("ascending") == "true" else found[::-1]


def formatted(statement, how, tongue):
    if how == "exact":
        return statement

    def person(value):
        if value.get("objectType") == "Group" and who(value) is None:
            return {"objectType": "Group", "member": [person(one) for one in value["member"]]}
        return {name: value[name] for name in ("objectType", "mbox", "mbox_sha1sum", "openid", "account") if name in value}

    def chosen(words):
        if not words:
            return words
        for wish in tongue:
            for tag in sorted(words, key=lambda tag: tag.lower() != wish.lower()):
                if tag.lower().split("-")[0] == wish.lower().split("-")[0]:
                    return {tag: words[tag]}
        tag = next(iter(words))
        return {tag: words[tag]}

    def walk(value, name=""):
        if isinstance(value, list):
            return [walk(one, name) for one in value]
        if not isinstance(value, dict) or name == "extensions":
            return value
        if how == "ids":
            if name in ("actor", "authority", "instructor", "team") or value.get("objectType") in ("Agent", "Group"):
                return person(value)
            if name in ("verb", "parent", "grouping", "category", "other") or (name == "object" and value.get("objectType", "Activity") == "Activity"):
                return {"id": value["id"]}
        if how == "canonical" and name in ("display", "name", "description") and all(isinstance(one, str) for one in value.values()):
            return chosen(value)
        return {key: walk(inner, key) for key, inner in value.items()}
    return walk(statement)


class Handler(BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"

    def log_message(self, *_):
        pass

    def setup(self):
        super().setup()
        self.connection.settimeout(30)

    # ---- one request

    def handle_one(self):
        lrs = self.server.lrs
        self.method, self.answered = self.command, False
        try:
            split = urllib.parse.urlsplit(self.path)
            path = split.path
            pairs = urllib.parse.parse_qsl(split.query, keep_blank_values=True)
            self.fields = {name.lower(): value for name, value in self.headers.items()}
            length = int(self.fields.get("content-length") or 0)
            if lrs.largest and length > lrs.largest:
                self.close_connection = True
                raise Refused(413, "too large")
            self.body = self.rfile.read(length)
            if "method" in dict(pairs):
                pairs = self.other_syntax(pairs)
            names = [name for name, _ in pairs]
            if len(set(names)) != len(names):
                raise Refused(400, "a parameter is there twice")
            self.query = dict(pairs)
            if not path.startswith(lrs.root):
                raise Refused(404, "nothing is here")
            self.route(path[len(lrs.root):])
        except Refused as refused:
            self.say(refused.status, {"error": str(refused)}, **refused.fields)
        except Wrong as wrong:
            self.say(400, {"error": str(wrong)})
        except (ConnectionError, TimeoutError):
            self.close_connection = True

    do_GET = do_HEAD = do_PUT = do_POST = do_DELETE = do_OPTIONS = do_PATCH = handle_one

    def other_syntax(self, pairs):
        if self.command != "POST" or len(pairs) != 1:
            raise Refused(400, "method alone, and by POST")
        self.method = pairs[0][1].upper()
        try:
            form = dict(urllib.parse.parse_qsl(self.body.decode("ascii"), keep_blank_values=True, strict_parsing=bool(self.body)))
        except (UnicodeError, ValueError):
            raise Refused(400, "this is no form") from None
        self.fields.pop("content-type", None)
        content = form.pop("content", None)
        for name in list(form):
            if name.lower() in ("authorization", "x-experience-api-version", "content-type", "content-length", "if-match", "if-none-match", "accept",
                                "accept-language", "accept-encoding"):
                self.fields[name.lower()] = form.pop(name)
        if self.method in ("PUT", "POST") and content is None:
            raise Refused(400, "content is missing")
        if content is not None:
            self.fields.setdefault("content-type", "application/json")
        self.body = (content or "").encode()
        return list(form.items())

    def route(self, path):
        lrs = self.server.lrs
        if path == "/about" and self.method in ("GET", "HEAD"):
            return self.say(200, {"version": ["1.0.0", "1.0.1", "1.0.2", "1.0.3"]})
        if lrs.launch and path == "/fetch":
            return self.fetch()
        if not re.match(r"^1\.0(\.\d+)?$", self.fields.get("x-experience-api-version", "")):
            raise Refused(400, "X-Experience-API-Version is missing, or another one")
        given = self.fields.get("authorization", "")
        if given not in lrs.authorizations():
            broken = not re.match(r"^Basic [A-Za-z0-9+/]+=*$", given) and given
            raise Refused(400 if broken and not given.startswith(("Basic", "OAuth")) else 401, "who are you?")
        rooms = {"/statements": self.statements, "/activities/state": self.state, "/activities/profile": self.activity_profile,
                 "/agents/profile": self.agent_profile, "/activities": self.activities, "/agents": self.agents}
        if path not in rooms:
            raise Refused(404, "nothing is here")
        lrs.seen.append((self.method, path, dict(self.query), len(self.body)))
        return rooms[path]()

    def say(self, status, content=None, kind="application/json", **fields):
        data = content if isinstance(content, bytes) else b"" if content is None else json.dumps(content).encode()
        fault = getattr(self, "fault", {})
        if fault.get("cut") == "after":
            return self.cut()
        self.send_response(status)
        self.send_header("X-Experience-API-Version", "1.0.3")
        self.send_header("X-Experience-API-Consistent-Through", written(now()))
        if content is not None:
            self.send_header("Content-Type", kind)
        if status != 204:
            self.send_header("Content-Length", str(len(data)))
        for name, value in fields.items():
            self.send_header(name.replace("_", "-"), value)
        self.end_headers()
        if self.method != "HEAD" and status != 204:
            if fault.get("cut") == "within":
                self.wfile.write(data[:len(data) // 2])
                self.wfile.flush()
                return self.cut()
            self.wfile.write(data)

    def cut(self):
        self.close_connection = True
        self.connection.shutdown(socket.SHUT_RDWR)

    def allow(self, *names):
        for name in self.query:
            if name not in names:
                raise Refused(400, f"there is no parameter {name}")

    # ---- statements

    def take_fault(self):
        lrs = self.server.lrs
        with lrs.lock:
            self.fault = lrs.faults.pop(0) if lrs.faults else {}
        time.sleep(self.fault.get("slow", 0))
        if self.fault.get("cut") == "before":
            self.cut()
            raise ConnectionError
        if "status" in self.fault:
            fields = {"Retry_After": str(self.fault["retry_after"])} if "retry_after" in self.fault else {}
            raise Refused(self.fault["status"], self.fault.get("body", "as the test wants"), **fields)

    def statements(self):
        if self.method in ("GET", "HEAD"):
            return self.get_statements()
        if self.method not in ("PUT", "POST"):
            raise Refused(405, "PUT, POST, GET")
        self.take_fault()
        content, parts = self.content()
        if self.method == "PUT":
            self.allow("statementId")
            need("statementId" in self.query, "statementId is missing")
            need(UUID.match(self.query["statementId"]), "statementId is no UUID")
            need(isinstance(content, dict), "a statement is an object")
            need(content.get("id", self.query["statementId"]).lower() == self.query["statementId"].lower(), "two ids")
            content["id"] = self.query["statementId"]
        else:
            self.allow()
        batch = content if isinstance(content, list) else [content]
        for one in batch:
            check_statement(one)
        ids = [one["id"].lower() for one in batch if "id" in one]
        need(len(set(ids)) == len(ids), "an id twice")
        self.check_parts(batch, parts)
        stored = written(now())
        for one in batch:
            one.setdefault("id", str(uuid.uuid4()))
            one.setdefault("timestamp", stored)
            one.setdefault("version", "1.0.0")
            one["stored"] = stored
            one["authority"] = {"objectType": "Agent", "account": {"homePage": "http://lrs.example", "name": "key"}}
            for part in [one, one["object"]]:
                for name, some in part.get("context", {}).get("contextActivities", {}).items():
                    part["context"]["contextActivities"][name] = some if isinstance(some, list) else [some]
            if one["actor"].get("objectType") is None:
                one["actor"]["objectType"] = "Agent"
        self.server.lrs.store.put(batch, parts)
        if self.method == "PUT":
            return self.say(204)
        return self.say(200, [one["id"] for one in batch])

    def content(self):
        """JSON, and the parts by their hash."""
        kind = self.fields.get("content-type", "")
        if kind.split(";")[0].strip().lower() == "application/json":
            return parsed(self.body), {}
        if kind.split(";")[0].strip().lower() != "multipart/mixed":
            raise Refused(400, f"content of the type {kind}")
        boundary = re.search(r'boundary="?([^";]+)"?', kind)
        need(boundary, "the boundary is missing")
        mark = b"--" + boundary[1].encode()
        need(self.body.rstrip().endswith(mark + b"--") and mark in self.body, "the boundary is not in the body")
        pieces = re.split(rb"(?:^|\r?\n)" + re.escape(mark), self.body)[1:-1]
        need(pieces, "no part")
        content, parts = None, {}
        for n, piece in enumerate(pieces):
            head, gap, data = piece.lstrip(b"\r\n").partition(b"\r\n\r\n") if b"\r\n\r\n" in piece else piece.lstrip(b"\n").partition(b"\n\n")
            need(gap, "a part without a head")
            fields = {k.lower(): v for k, v in email.parser.BytesParser(policy=email.policy.HTTP).parsebytes(head + b"\r\n\r\n").items()}
            if n == 0:
                need(fields.get("content-type", "").split(";")[0] == "application/json", "the first part is no JSON")
                content = parsed(data)
                continue
            need(fields.get("content-transfer-encoding") == "binary", "Content-Transfer-Encoding")
            need("x-experience-api-hash" in fields, "X-Experience-API-Hash")
            need(hashlib.sha256(data).hexdigest() == fields["x-experience-api-hash"].lower(), "the hash")
            parts[fields["x-experience-api-hash"].lower()] = (fields.get("content-type", "application/octet-stream"), data)
        return content, parts

    def check_parts(self, batch, parts):
        wanted = set()
        for statement in batch:
            for thing in [statement, statement["object"]]:
                for one in thing.get("attachments", []):
                    wanted.add(one["sha2"].lower())
                    need("fileUrl" in one or one["sha2"].lower() in parts, "an attachment's bytes are missing")
                    if one["usageType"] == SIGNATURE:
                        need(one["contentType"] == "application/octet-stream", "a signature's type")
                        if one["sha2"].lower() in parts:
                            check_signature(statement, parts[one["sha2"].lower()][1])
        need(set(parts) <= wanted, "a part that nobody asked for")

    def get_statements(self):
        lrs = self.server.lrs
        if "more" in self.query:
            return self.page(json.loads(base64.urlsafe_b64decode(self.query["more"])))
        how = self.query.get("format", "exact")
        need(how in ("exact", "ids", "canonical"), "format")
        for name in ("related_activities", "related_agents", "attachments", "ascending"):
            need(self.query.get(name, "true") in ("true", "false"), name)
        single = [name for name in ("statementId", "voidedStatementId") if name in self.query]
        if single:
            self.allow(single[0], "format", "attachments")
            need(UUID.match(self.query[single[0]]), f"{single[0]} is no UUID")
            with lrs.store.lock:
                found, voided = lrs.store.one(self.query[single[0]])
            if not found or voided != (single[0] == "voidedStatementId"):
                raise Refused(404, "there is no such statement")
            return self.say_statements(formatted(found, how, self.tongues()), [found], time_of(found["stored"]))
        self.allow(*FILTERS)
        query = self.query
        if "agent" in query:
            agent(parsed(query["agent"].encode()), "agent")
        for name in ("verb", "activity"):
            if name in query:
                iri(query[name], name)
        if "registration" in query:
            need(UUID.match(query["registration"]), "registration is no UUID")
        for name in ("since", "until"):
            if name in query:
                time_of(query[name], name)
        need(re.match(r"^\d+$", query.get("limit", "0")), "limit")
        return self.page({"query": query, "from": 0})

    def page(self, where):
        lrs = self.server.lrs
        query = where["query"]
        with lrs.store.lock:
            found = lrs.store.find(query)
        limit = min(int(query.get("limit", 0)) or lrs.page, lrs.page)
        if "last" in where:  # new ones do not move the pages
            ascending = query.get("ascending") == "true"
            found = [(n, one) for n, one in found if (n > where["last"] if ascending else n < where["last"])]
        some = found[:limit]
        more = ""
        if len(found) > limit:
            mark = base64.urlsafe_b64encode(json.dumps({"query": query, "last": some[-1][0]}).encode()).decode()
            more = f"{lrs.root}/statements?more={urllib.parse.quote(mark)}"
        how = query.get("format", "exact")
        self.query = query
        content = {"statements": [formatted(one, how, self.tongues()) for _, one in some], "more": more}
        return self.say_statements(content, [one for _, one in some], time_of(some[0][1]["stored"]) if some else now())

    def tongues(self):
        wishes = [one.split(";")[0].strip() for one in self.fields.get("accept-language", "").split(",")]
        return [one for one in wishes if LANGUAGE.match(one)]

    def say_statements(self, content, statements, changed):
        last = changed.strftime("%a, %d %b %Y %H:%M:%S GMT")
        if self.query.get("attachments") != "true":
            return self.say(200, content, Last_Modified=last)
        mark = uuid.uuid4().hex
        out = f"--{mark}\r\nContent-Type: application/json\r\n\r\n".encode() + json.dumps(content).encode() + b"\r\n"
        done = set()
        for statement in statements:
            for one in statement.get("attachments", []) + statement["object"].get("attachments", []):
                row = self.server.lrs.store.db.execute("SELECT type, data FROM attachment WHERE sha2 = ?", (one["sha2"].lower(),)).fetchone()
                if row and one["sha2"] not in done:
                    done.add(one["sha2"])
                    out += (f"--{mark}\r\nContent-Type: {row[0]}\r\nContent-Transfer-Encoding: binary\r\n"
                            f"X-Experience-API-Hash: {one['sha2']}\r\n\r\n").encode() + row[1] + b"\r\n"
        return self.say(200, out + f"--{mark}--\r\n".encode(), f"multipart/mixed; boundary={mark}", Last_Modified=last)

    # ---- documents

    def state(self):
        single = "stateId" in self.query
        self.allow("activityId", "agent", "registration", *(["stateId"] if single else ["since"] if self.method in ("GET", "HEAD") else []))
        owner = [self.an_activity(), self.an_agent()]
        registration = self.query.get("registration")
        if registration is not None:
            need(UUID.match(registration), "registration is no UUID")
        return self.document("state", json.dumps(owner + [registration]), "stateId", False, json.dumps(owner))

    def activity_profile(self):
        self.allow("activityId", *(["profileId"] if "profileId" in self.query else ["since"] if self.method in ("GET", "HEAD") else []))
        return self.document("activity", self.an_activity(), "profileId", True)

    def agent_profile(self):
        self.allow("agent", *(["profileId"] if "profileId" in self.query else ["since"] if self.method in ("GET", "HEAD") else []))
        return self.document("agent", self.an_agent(), "profileId", True)

    def an_activity(self):
        need("activityId" in self.query, "activityId is missing")
        iri(self.query["activityId"], "activityId")
        return self.query["activityId"]

    def an_agent(self):
        need("agent" in self.query, "agent is missing")
        value = parsed(self.query["agent"].encode())
        agent(value, "agent")
        return who(value)

    def document(self, kind, owner, name, guarded, any_registration=None):
        db, lock = self.server.lrs.store.db, self.server.lrs.store.lock
        key = (kind, owner, self.query.get(name))
        with lock:
            if name not in self.query:
                return self.documents(kind, owner, name, any_registration)
            row = db.execute("SELECT type, data, updated FROM document WHERE kind = ? AND owner = ? AND id = ?", key).fetchone()
            if kind == "state" and row is None and self.method in ("GET", "HEAD") and "registration" not in self.query:
                rows = db.execute("SELECT type, data, updated FROM document WHERE kind = ? AND id = ? AND owner LIKE ?",
                                  (kind, key[2], any_registration[:-1] + "%")).fetchall()
                row = rows[-1] if rows else None
            tag = f'"{hashlib.sha1(row[1]).hexdigest()}"' if row else None
            if self.method in ("GET", "HEAD"):
                if row is None:
                    raise Refused(404, "there is no such document")
                at = time_of(row[2]).strftime("%a, %d %b %Y %H:%M:%S GMT")
                return self.say(200, bytes(row[1]), row[0], ETag=tag, Last_Modified=at)
            self.check_tags(tag, guarded)
            if self.method == "DELETE":
                db.execute("DELETE FROM document WHERE kind = ? AND owner = ? AND id = ?", key)
                return self.say(204)
            if self.method not in ("PUT", "POST"):
                raise Refused(405, "GET, PUT, POST, DELETE")
            typed, data = self.fields.get("content-type", "application/octet-stream"), self.body
            is_json = typed.split(";")[0].strip().lower() == "application/json"
            if self.method == "POST":
                if is_json:
                    need(isinstance(parsed(data), dict), "this is no JSON object")
                if row:
                    need(is_json and row[0].split(";")[0] == "application/json", "only JSON can be merged")
                    old = parsed(bytes(row[1]))
                    need(isinstance(old, dict), "what is there is no JSON object")
                    data = json.dumps({**old, **parsed(data)}).encode()
            elif is_json:
                parsed(data)
            db.execute("INSERT OR REPLACE INTO document VALUES (?, ?, ?, ?, ?, ?)", key + (typed, data, written(now())))
            return self.say(204)

    def check_tags(self, tag, guarded):
        match, none = self.fields.get("if-match"), self.fields.get("if-none-match")
        if match is not None and match != "*" and match.strip('"') != (tag or "").strip('"'):
            raise Refused(412, "it was changed meanwhile")
        if match == "*" and tag is None:
            raise Refused(412, "there is none")
        if none is not None and tag is not None and (none == "*" or none.strip('"') == tag.strip('"')):
            raise Refused(412, "there is one")
        if guarded and self.method == "PUT" and match is None and none is None:
            raise Refused(409 if tag else 400, "say with If-Match or If-None-Match what you know of it")

    def documents(self, kind, owner, name, any_registration):
        db = self.server.lrs.store.db
        how, value = "owner = ?", owner
        if kind == "state" and "registration" not in self.query:
            how, value = "owner LIKE ?", any_registration[:-1] + "%"
        if self.method == "DELETE" and kind == "state":
            db.execute(f"DELETE FROM document WHERE kind = ? AND {how}", (kind, value))
            return self.say(204)
        if self.method not in ("GET", "HEAD"):
            raise Refused(400, f"{name} is missing")
        since = time_of(self.query["since"], "since") if "since" in self.query else None
        rows = db.execute(f"SELECT id, updated FROM document WHERE kind = ? AND {how}", (kind, value)).fetchall()
        return self.say(200, sorted({one for one, at in rows if since is None or time_of(at) > since}))

    # ---- activities, agents

    def activities(self):
        if self.method not in ("GET", "HEAD"):
            raise Refused(405, "GET")
        self.allow("activityId")
        identity = self.an_activity()
        with self.server.lrs.store.lock:
            row = self.server.lrs.store.db.execute("SELECT definition FROM activity WHERE id = ?", (identity,)).fetchone()
        out = {"objectType": "Activity", "id": identity}
        if row and row[0] != "{}":
            out["definition"] = json.loads(row[0])
        return self.say(200, out)

    def agents(self):
        if self.method not in ("GET", "HEAD"):
            raise Refused(405, "GET")
        self.allow("agent")
        wanted = self.an_agent()
        value = parsed(self.query["agent"].encode())
        out = {"objectType": "Person"}
        for name in ("mbox", "mbox_sha1sum", "openid", "account"):
            if name in value:
                out[name] = [value[name]]
        names = set([value["name"]] if "name" in value else [])
        with self.server.lrs.store.lock:
            for (text,) in self.server.lrs.store.db.execute("SELECT json FROM statement"):
                actor = json.loads(text)["actor"]
                if who(actor) == wanted and "name" in actor:
                    names.add(actor["name"])
        if names:
            out["name"] = sorted(names)
        return self.say(200, out)

    # ---- the part of a learning management system (cmi5)

    def fetch(self):
        lrs = self.server.lrs
        if self.method != "POST":
            raise Refused(405, "POST")
        if lrs.launch.get("fetched"):
            return self.say(200, {"error-code": "1", "error-text": "The authorization token has already been returned."})
        lrs.launch["fetched"] = True
        return self.say(200, {"auth-token": lrs.launch["token"]})


class Server(ThreadingHTTPServer):
    daemon_threads = True

    def handle_error(self, *_):
        kind = sys.exc_info()[0]
        if not issubclass(kind, (ConnectionError, TimeoutError)):
            super().handle_error(*_)


class Lrs:
    def __init__(self, file=":memory:", port=0, key="key:secret", certificate=None):
        self.root, self.page, self.largest = "/xapi", PAGE, 0
        self.store, self.key = Store(file), key
        self.lock, self.faults, self.seen, self.launch = threading.Lock(), [], [], {}
        self.server = Server(("127.0.0.1", port), Handler)
        self.server.lrs = self
        if certificate:
            tls = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
            tls.load_cert_chain(*certificate)
            self.server.socket = tls.wrap_socket(self.server.socket, server_side=True)
        scheme = "https" if certificate else "http"
        self.endpoint = f"{scheme}://localhost:{self.server.server_port}{self.root}"

    def authorizations(self):
        out = ["Basic " + base64.b64encode(self.key.encode()).decode()]
        return out + (["Basic " + self.launch["token"]] if self.launch.get("fetched") else [])

    def __enter__(self):
        threading.Thread(target=self.server.serve_forever, kwargs={"poll_interval": 0.05}, daemon=True).start()
        return self

    def __exit__(self, *_):
        self.server.shutdown()
        self.server.server_close()

    def statements(self):
        """All, in the order in which they came; and whether each is voided."""
        with self.store.lock:
            return [(json.loads(text), bool(voided)) for text, voided in self.store.db.execute("SELECT json, voided FROM statement ORDER BY n")]


if __name__ == "__main__":
    wanted = argparse.ArgumentParser()
    wanted.add_argument("--port", type=int, default=0)
    wanted.add_argument("--key", default="key:secret")
    wanted.add_argument("--file", default=":memory:")
    given = wanted.parse_args()
    lrs = Lrs(given.file, given.port, given.key)
    print(lrs.endpoint, flush=True)
    lrs.server.serve_forever()
