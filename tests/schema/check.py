#!/usr/bin/env python3
"""Holds the JSON Schema against every scene, by two checkers of which one knows no unevaluatedProperties.

  tests/schema/check.py PROGRAM SCENES      SCENES: a folder; all .toml in it and below

Every scene is right. The same scene is wrong with one key more, or with one misspelt, in any of its tables that
has not the names of the author's choice. Debian: python3-jsonschema, python3-fastjsonschema.
"""
import copy
import json
import pathlib
import subprocess
import sys
import tomllib

import fastjsonschema
import jsonschema

# Tables whose keys are names of the author's choice.
FREE = {("params",), ("frame",), ("material",), ("camera",)}


def tables_of(node, path=()):
    """Paths of all tables below, the document's own among them."""
    if isinstance(node, dict):
        yield path
        for name, value in node.items():
            yield from tables_of(value, path + (name,))
    elif isinstance(node, list):
        for i, value in enumerate(node):
            yield from tables_of(value, path + (i,))


def at(document, path):
    for step in path:
        document = document[step]
    return document


def is_free(document, path):
    if path not in FREE:
        return False
    table = at(document, path)
    return path == ("params",) or all(isinstance(value, dict) for value in table.values())


def misspelt(name):
    """The first two letters the other way round, or one doubled."""
    swapped = name[1] + name[0] + name[2:] if len(name) > 1 else name
    return swapped if swapped != name else name[0] + name


def kind_of(document, path):
    """What a table is, as far as the schema tells tables apart."""
    table = at(document, path)
    names = tuple("#" if isinstance(step, int) or path[:i] in FREE else step for i, step in enumerate(path))
    choices = tuple(str(table.get(key)) for key in ("shape", "type", "projection"))
    return names + choices


def mutations(document, seen):
    """(what, document) with one wrong key; of tables and keys that were not met before."""
    for path in tables_of(document):
        if is_free(document, path):
            continue
        kind = kind_of(document, path)
        if kind not in seen:
            seen.add(kind)
            wrong = copy.deepcopy(document)
            at(wrong, path)["no_such_key"] = 1
            yield f"{path} + no_such_key", wrong
        for name in at(document, path):
            if (kind, name) in seen:
                continue
            seen.add((kind, name))
            wrong = copy.deepcopy(document)
            table = at(wrong, path)
            table[misspelt(name)] = table.pop(name)
            yield f"{path}: {misspelt(name)}", wrong


def main():
    program, scenes = sys.argv[1], pathlib.Path(sys.argv[2])
    schema = json.loads(subprocess.run([program, "schema"], check=True, capture_output=True).stdout)
    jsonschema.validators.validator_for(schema).check_schema(schema)
    full = jsonschema.Draft202012Validator(schema)
    compiled = fastjsonschema.compile(schema, use_default=False)
    filling = fastjsonschema.compile(schema)  # puts defaults into the document

    def is_refused(document):
        try:
            compiled(document)
            by_simple = False
        except fastjsonschema.JsonSchemaException:
            by_simple = True
        return not full.is_valid(document), by_simple

    failures, checked, seen = [], 0, set()
    files = sorted(scenes.rglob("*.toml"))
    for file in files:
        document = tomllib.loads(file.read_text(encoding="utf-8"))
        if any(is_refused(document)):
            reasons = [error.message[:200] for error in full.iter_errors(document)]
            failures.append(f"{file}: refused: {reasons}")
        try:
            filling(filling(copy.deepcopy(document)))
        except fastjsonschema.JsonSchemaException as error:
            failures.append(f"{file}: refused with its defaults: {error.message[:200]}")
        for what, wrong in mutations(document, seen):
            checked += 1
            if not all(is_refused(wrong)):
                failures.append(f"{file}: not refused by both: {what}: {is_refused(wrong)}")
    # A key of another choice: of all shapes but one.
    for shape, keys in (("sphere", {"radius": 1, "minor": 0.1}), ("box", {"size": [1, 1, 1], "radius": 1})):
        for where in ({"object": [{"shape": shape, **keys}]},
                      {"object": [{"shape": "union", "part": [{"shape": shape, **keys}] * 2}]}):
            checked += 1
            if not all(is_refused({"camera": {}, **where})):
                failures.append(f"a {shape} with {list(keys)} is not refused")
    print(f"{len(files)} scenes, {checked} mistakes")
    if failures or len(files) < 30 or checked < 250:
        print(*failures, sep="\n", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
