"""Writes plain data as TOML: what `tomllib` read, given back. Floats by repr, so no bit is lost."""
import json
import re

BARE_KEY = re.compile(r"[A-Za-z0-9_-]+\Z")


def key_text(key):
    """A key, quoted if it must be."""
    return key if BARE_KEY.match(key) else json.dumps(key)


def value_text(value):
    """A value on one line."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, str):
        return json.dumps(value)
    if isinstance(value, list):
        return "[" + ", ".join(value_text(v) for v in value) + "]"
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key_text(k)} = {value_text(v)}" for k, v in value.items()) + " }"
    raise TypeError(f"cannot write {type(value)} as TOML")


def is_list_of_tables(value):
    """Whether a value is written as [[...]] sections."""
    return isinstance(value, list) and bool(value) and all(isinstance(v, dict) for v in value)


def document_text(document):
    """A document: plain keys first, then a section for each table one or two levels deep."""
    lines = [f"{key_text(k)} = {value_text(v)}" for k, v in document.items()
             if not isinstance(v, dict) and not is_list_of_tables(v)]
    for key, value in document.items():
        if is_list_of_tables(value):
            for table in value:
                lines += ["", f"[[{key_text(key)}]]", *section(table)]
        elif isinstance(value, dict) and key in ("frame", "material"):
            for name, table in value.items():
                lines += ["", f"[{key_text(key)}.{key_text(name)}]", *section(table)]
        elif isinstance(value, dict):
            lines += ["", f"[{key_text(key)}]", *section(value)]
    return "\n".join(lines) + "\n"


def section(table):
    """The keys of a table, nested tables inline."""
    return [f"{key_text(k)} = {value_text(v)}" for k, v in table.items()]
