"""What a statement of xAPI 1.0.3 may look like (adlnet/xAPI-Spec, xAPI-Data.md). Python's library alone.

    check_statement(statement)       raises Wrong with a sentence
"""
import base64
import binascii
import datetime
import json
import re

VOIDED = "http://adlnet.gov/expapi/verbs/voided"
SIGNATURE = "http://adlnet.gov/expapi/attachments/signature"
UUID = re.compile(r"^[0-9a-f]{8}-[0-9a-f]{4}-[1-5][0-9a-f]{3}-[89ab][0-9a-f]{3}-[0-9a-f]{12}$", re.I)
IRI = re.compile(r"^[a-zA-Z][a-zA-Z0-9+.-]*:[^\s<>\"{}|\\^`]+$")
LANGUAGE = re.compile(r"^(?:(?:[a-z]{2,3}(?:-[a-z]{3}){0,3}|[a-z]{4}|[a-z]{5,8})(?:-[a-z]{4})?(?:-(?:[a-z]{2}|\d{3}))?"
                      r"(?:-(?:[a-z0-9]{5,8}|\d[a-z0-9]{3}))*(?:-[0-9a-wy-z](?:-[a-z0-9]{2,8})+)*(?:-x(?:-[a-z0-9]{1,8})+)?"
                      r"|x(?:-[a-z0-9]{1,8})+|i-[a-z]+|[a-z]{2}-[a-z]+)$", re.I)
DURATION = re.compile(r"^P(?:\d+(?:\.\d+)?W|(?=.)(?:\d+(?:\.\d+)?Y)?(?:\d+(?:\.\d+)?M)?(?:\d+(?:\.\d+)?D)?(?:T(?=.)(?:\d+(?:\.\d+)?H)?(?:\d+(?:\.\d+)?M)?"
                      r"(?:\d+(?:\.\d+)?S)?)?)$")
TIME = re.compile(r"^(\d{4})-(\d{2})-(\d{2})[T ](\d{2}):(\d{2}):(\d{2})(?:[.,](\d+))?(Z|[+-]\d{2}(?::?\d{2})?)?$", re.I)
IFIS = ("mbox", "mbox_sha1sum", "openid", "account")
LISTS = {"choice": ["choices"], "sequencing": ["choices"], "likert": ["scale"], "matching": ["source", "target"], "performance": ["steps"]}
KINDS = ["true-false", "choice", "fill-in", "long-fill-in", "matching", "performance", "sequencing", "likert", "numeric", "other"]


class Wrong(Exception):
    pass


def need(good, what):
    if not good:
        raise Wrong(what)


def only(thing, what, *names, must=()):
    need(isinstance(thing, dict), f"{what} is no object")
    for name in thing:
        need(name in names, f"{what}: there is no {name}")
        need(thing[name] is not None, f"{what}: {name} is null")
    for name in must:
        need(name in thing, f"{what}: {name} is missing")


def text(value, what):
    need(isinstance(value, str), f"{what} is no text")


def iri(value, what):
    need(isinstance(value, str) and IRI.match(value), f"{what} is no IRI")


def uuid(value, what):
    need(isinstance(value, str) and UUID.match(value), f"{what} is no UUID")


def flag(value, what):
    need(isinstance(value, bool), f"{what} is no true or false")


def number(value, what):
    need(isinstance(value, (int, float)) and not isinstance(value, bool), f"{what} is no number")


def time(value, what="timestamp"):
    found = TIME.match(value) if isinstance(value, str) else None
    need(found, f"{what} is no time")
    need(found[8] not in ("-00", "-0000", "-00:00"), f"{what} has an unknown zone")
    year, month, day, hour, minute, second = (int(found[n]) for n in range(1, 7))
    zone = found[8] or "Z"
    shift = datetime.timedelta()
    if zone.upper() != "Z":
        digits = zone[1:].replace(":", "").ljust(4, "0")
        shift = datetime.timedelta(hours=int(digits[:2]), minutes=int(digits[2:])) * (-1 if zone[0] == "-" else 1)
    try:
        at = datetime.datetime(year, month, day, hour, minute, min(second, 59), int((found[7] or "0")[:6].ljust(6, "0")))
    except ValueError:
        raise Wrong(f"{what} is no time") from None
    return at - shift  # UTC


def languages(value, what):
    need(isinstance(value, dict), f"{what} is no object")
    for tag, said in value.items():
        need(LANGUAGE.match(tag), f"{what}: {tag} is no language")
        text(said, what)


def extensions(value, what):
    need(isinstance(value, dict), f"{what} is no object")
    for key in value:
        iri(key, what)


def agent(value, what, kind=None):
    only(value, what, "objectType", "name", "member", *IFIS)
    if kind:
        need(value.get("objectType", kind if kind == "Agent" else None) == kind, f"{what} is no {kind}")
    need(value.get("objectType", "Agent") in ("Agent", "Group"), f"{what}: objectType")
    if "name" in value:
        text(value["name"], what)
    known = [name for name in IFIS if name in value]
    need(len(known) <= 1, f"{what} has more than one identifier")
    if value.get("objectType", "Agent") == "Agent":
        need(len(known) == 1, f"{what} has no identifier")
        need("member" not in value, f"{what}: an agent has no members")
    else:
        if not known:
            need(value.get("member"), f"{what}: a group without an identifier needs members")
        if "member" in value:
            need(isinstance(value["member"], list), f"{what}: members")
            for one in value["member"]:
                agent(one, what, "Agent")
    for name in known:
        identifier(name, value[name], what)


def identifier(name, value, what):
    if name == "mbox":
        need(isinstance(value, str) and re.match(r"^mailto:[^\s@]+@[^\s@]+\.?[^\s@]*$", value), f"{what}: mbox")
    elif name == "mbox_sha1sum":
        need(isinstance(value, str) and re.match(r"^[0-9a-fA-F]{40}$", value), f"{what}: mbox_sha1sum")
    elif name == "openid":
        iri(value, what)
    else:
        only(value, what + ".account", "homePage", "name", must=("homePage", "name"))
        iri(value["homePage"], what)
        text(value["name"], what)


def verb(value):
    only(value, "verb", "id", "display", must=("id",))
    iri(value["id"], "verb.id")
    if "display" in value:
        languages(value["display"], "verb.display")


def components(value, what):
    need(isinstance(value, list), f"{what} is no list")
    seen = set()
    for one in value:
        only(one, what, "id", "description", must=("id",))
        text(one["id"], what)
        need(one["id"] not in seen, f"{what}: an id twice")
        seen.add(one["id"])
        if "description" in one:
            languages(one["description"], what)


def definition(value):
    only(value, "definition", "name", "description", "type", "moreInfo", "extensions", "interactionType", "correctResponsesPattern",
         "choices", "scale", "source", "target", "steps")
    for name in ("name", "description"):
        if name in value:
            languages(value[name], name)
    for name in ("type", "moreInfo"):
        if name in value:
            iri(value[name], name)
    if "extensions" in value:
        extensions(value["extensions"], "extensions")
    kind = value.get("interactionType")
    if kind is not None:
        need(kind in KINDS, "interactionType")
    if "correctResponsesPattern" in value:
        pattern = value["correctResponsesPattern"]
        need(kind is not None and isinstance(pattern, list) and all(isinstance(one, str) for one in pattern), "correctResponsesPattern")
    for name in ("choices", "scale", "source", "target", "steps"):
        if name in value:
            need(name in LISTS.get(kind, []), f"{name} does not belong to {kind}")
            components(value[name], name)


def activity(value, what="object"):
    only(value, what, "objectType", "id", "definition", must=("id",))
    need(value.get("objectType", "Activity") == "Activity", f"{what} is no activity")
    iri(value["id"], what)
    if "definition" in value:
        definition(value["definition"])


def reference(value, what):
    only(value, what, "objectType", "id", must=("objectType", "id"))
    need(value["objectType"] == "StatementRef", f"{what} is no StatementRef")
    uuid(value["id"], what)


def result(value):
    only(value, "result", "score", "success", "completion", "response", "duration", "extensions")
    for name in ("success", "completion"):
        if name in value:
            flag(value[name], name)
    if "response" in value:
        text(value["response"], "response")
    if "duration" in value:
        need(isinstance(value["duration"], str) and DURATION.match(value["duration"]), "duration")
    if "extensions" in value:
        extensions(value["extensions"], "extensions")
    if "score" in value:
        score = value["score"]
        only(score, "score", "scaled", "raw", "min", "max")
        for name in score:
            number(score[name], name)
        need(-1 <= score.get("scaled", 0) <= 1, "scaled")
        low, high, raw = (score.get(name) for name in ("min", "max", "raw"))
        need(low is None or high is None or low < high, "min and max")
        need(raw is None or ((low is None or raw >= low) and (high is None or raw <= high)), "raw")


def context(value, of_activity):
    only(value, "context", "registration", "instructor", "team", "contextActivities", "revision", "platform", "language", "statement", "extensions")
    if "registration" in value:
        uuid(value["registration"], "registration")
    if "instructor" in value:
        agent(value["instructor"], "instructor")
    if "team" in value:
        agent(value["team"], "team", "Group")
    for name in ("revision", "platform"):
        if name in value:
            text(value[name], name)
            need(of_activity, f"{name} needs an activity")
    if "language" in value:
        need(isinstance(value["language"], str) and LANGUAGE.match(value["language"]), "language")
    if "statement" in value:
        reference(value["statement"], "context.statement")
    if "extensions" in value:
        extensions(value["extensions"], "extensions")
    if "contextActivities" in value:
        only(value["contextActivities"], "contextActivities", "parent", "grouping", "category", "other")
        for some in value["contextActivities"].values():
            for one in some if isinstance(some, list) else [some]:
                activity(one, "contextActivities")


def attachment(value):
    only(value, "attachment", "usageType", "display", "description", "contentType", "length", "sha2", "fileUrl",
         must=("usageType", "display", "contentType", "length", "sha2"))
    iri(value["usageType"], "usageType")
    languages(value["display"], "display")
    if "description" in value:
        languages(value["description"], "description")
    need(isinstance(value["contentType"], str) and re.match(r"^[\w.+-]+/[\w.+-]+(\s*;.*)?$", value["contentType"]), "contentType")
    need(isinstance(value["length"], int) and not isinstance(value["length"], bool), "length")
    need(isinstance(value["sha2"], str) and re.match(r"^[0-9a-fA-F]{64}$", value["sha2"]), "sha2")
    if "fileUrl" in value:
        iri(value["fileUrl"], "fileUrl")


def common(value, what, *more):
    only(value, what, "actor", "verb", "object", "result", "context", "timestamp", "attachments", *more, must=("actor", "verb", "object"))
    agent(value["actor"], "actor")
    verb(value["verb"])
    if "result" in value:
        result(value["result"])
    thing = value["object"]
    need(isinstance(thing, dict), "object is no object")
    kind = thing.get("objectType", "Activity")
    if "context" in value:
        context(value["context"], kind == "Activity")
    if "timestamp" in value:
        time(value["timestamp"])
    if "attachments" in value:
        need(isinstance(value["attachments"], list), "attachments")
        for one in value["attachments"]:
            attachment(one)
    return thing, kind


def check_statement(value):
    thing, kind = common(value, "statement", "id", "stored", "authority", "version", "objectType")
    need("objectType" not in value, "statement: objectType")
    if "id" in value:
        uuid(value["id"], "id")
    if "stored" in value:
        time(value["stored"], "stored")
    if "version" in value:
        need(isinstance(value["version"], str) and re.match(r"^1\.0(\.\d+)?$", value["version"]), "version")
    if "authority" in value:
        agent(value["authority"], "authority")
        if value["authority"].get("objectType") == "Group":  # OAuth's pair
            members = value["authority"].get("member", [])
            anonymous = not any(name in value["authority"] for name in IFIS)
            need(anonymous and len(members) == 2, "authority: a group without OAuth")
    if value["verb"]["id"] == VOIDED:
        need(kind == "StatementRef", "voided needs a StatementRef")
    if kind == "SubStatement":
        inner, inside = common({k: v for k, v in thing.items() if k != "objectType"}, "SubStatement")
        need(inside != "SubStatement", "a SubStatement within a SubStatement")
        check_object(inner, inside)
    else:
        check_object(thing, kind)


def check_object(thing, kind):
    if kind == "Activity":
        activity(thing)
    elif kind in ("Agent", "Group"):
        agent(thing, "object", kind)
    elif kind == "StatementRef":
        reference(thing, "object")
    else:
        raise Wrong(f"objectType {kind}")


def check_signature(statement, data):
    """data: the attachment's bytes, a JWS."""
    try:
        head, payload, signature = data.decode("ascii").split(".")
        decoded = [json.loads(base64.urlsafe_b64decode(part + "=" * (-len(part) % 4))) for part in (head, payload)]
    except (ValueError, binascii.Error):
        raise Wrong("the signature is no JWS") from None
    need(signature and decoded[0].get("alg") in ("RS256", "RS384", "RS512"), "the signature's algorithm")
    need(same(decoded[1], statement), "the signature is of another statement")


def parsed(raw):
    """JSON without a name twice, NaN and lone surrogates."""
    def pairs(some):
        out = {}
        for name, value in some:
            need(name not in out, f"{name} is there twice")
            out[name] = value
        return out

    def constant(name):
        raise Wrong(f"{name} is no JSON")
    try:
        out = json.loads(raw.decode("utf-8"), object_pairs_hook=pairs, parse_constant=constant)
        json.dumps(out, ensure_ascii=False).encode()
        return out
    except (UnicodeError, ValueError):
        raise Wrong("this is no JSON") from None


def plain(statement, top=True):
    """What two statements are compared by: without what a server adds, and as it stores it."""
    out = {name: value for name, value in statement.items() if not (top and name in ("id", "stored", "authority", "version", "timestamp", "attachments"))}
    out["verb"] = out["verb"]["id"]
    thing = dict(out["object"])
    kind = thing.pop("objectType", "Activity")
    thing.pop("definition", None)
    if kind == "SubStatement":
        thing = plain(thing, False)
    out["object"] = [kind, thing]
    for name in ("actor",):
        who = dict(out[name])
        who.setdefault("objectType", "Agent")
        out[name] = who
    if "context" in out:
        about = dict(out["context"])
        if "contextActivities" in about:
            about["contextActivities"] = {name: sorted(one["id"] for one in (some if isinstance(some, list) else [some]))
                                          for name, some in about["contextActivities"].items()}
        out["context"] = about
    return out


def same(a, b):
    try:
        return plain(a) == plain(b)
    except (KeyError, TypeError, AttributeError):
        return False
