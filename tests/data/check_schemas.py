#!/usr/bin/env python3
"""Checks the JSON Schemas under data/schema with an implementation that is not ours (python3-jsonschema).

    check_schemas.py DATA schemas           they are valid, every key is described, every number has a unit
    check_schemas.py DATA examples          every example under DATA obeys its schema
    check_schemas.py DATA documents TABLE…  tables of documents to accept and to reject (as documents_test.cpp)
    check_schemas.py DATA written DIR       files that grainlaw wrote into DIR obey their schemas
    check_schemas.py DATA mutants DIR       the readers and the schemas agree on documents spoilt in one place
"""
import copy
import csv
import json
import pathlib
import sys

from jsonschema import Draft202012Validator
from jsonschema.exceptions import best_match


def load(file):
    with open(file, encoding="utf-8") as stream:
        return json.load(stream)


class Schemas:
    """All schemas as one document, so that references between them need neither network nor registry."""

    def __init__(self, folder):
        self.each = {file.name: load(file) for file in sorted(folder.glob("*.schema.json"))}
        self.definitions = {name: self.inside(schema, name) for name, schema in self.each.items()}

    def inside(self, node, name):
        if isinstance(node, list):
            return [self.inside(item, name) for item in node]
        if not isinstance(node, dict):
            return node
        moved = {key: self.inside(value, name) for key, value in node.items() if key != "$schema"}
        if isinstance(node.get("$ref"), str):
            file, _, pointer = node["$ref"].partition("#")
            moved["$ref"] = f"#/$defs/{file or name}{pointer}"
        return moved

    def validator(self, name):
        if name not in self.each:
            raise SystemExit(f"no such schema: {name}")
        return Draft202012Validator({"$defs": self.definitions, "$ref": f"#/$defs/{name}"})

    def complaint(self, name, document):
        """None where the document is accepted, else the reason."""
        error = best_match(self.validator(name).iter_errors(document))
        return error and f"{'/'.join(map(str, error.absolute_path))}: {error.message}"[:300]

    def resolve(self, name, node):
        """The node with everything its reference says."""
        if "$ref" not in node:
            return node
        file, _, pointer = node["$ref"].partition("#")
        target = self.each[file or name]
        for step in filter(None, pointer.split("/")):
            target = target[step]
        return self.resolve(file or name, target) | {key: value for key, value in node.items() if key != "$ref"}


def check_schemas(schemas):
    """Each is valid; objects are closed; every key has a description and every number a unit."""
    faults = []

    def types(node):
        kind = node.get("type", [])
        return {kind} if isinstance(kind, str) else set(kind)

    def visit(name, node, where, conditional=False):
        if isinstance(node, list):
            for index, item in enumerate(node):
                visit(name, item, f"{where}/{index}", conditional)
        if not isinstance(node, dict):
            return
        for key, value in node.items():
            inner = conditional or key in ("if", "not", "then", "else", "dependentSchemas")
            own = key == "properties" and not conditional and ("$ref" not in node or "unevaluatedProperties" in node)
            if own:
                for prop, schema in value.items():
                    if schema is False:
                        continue
                    full = schemas.resolve(name, schema)
                    if "const" in full and prop != "format" or prop == "mode":
                        continue  # the tag of a segment
                    if "description" not in full:
                        faults.append(f"{name}{where}: {prop} has no description")
                    elif types(full) & {"number", "integer"} and "Unit:" not in full["description"]:
                        faults.append(f"{name}{where}: {prop} has no unit")
            if key == "properties":
                for prop, schema in value.items():
                    visit(name, schema, f"{where}/{prop}", inner)
            else:
                visit(name, value, f"{where}/{key}", inner)

    for name, schema in schemas.each.items():
        Draft202012Validator.check_schema(schema)
        visit(name, schema, "")
    return faults, len(schemas.each)


def check_examples(schemas, data):
    faults, count = [], 0
    kinds = {"paths": "path", "scenes": "scene", "campaigns": "campaign", "thesis": "parameters", "grains": "parameters"}
    for folder, kind in kinds.items():
        files = sorted((data / folder).glob("*.json"))
        if not files:
            faults.append(f"no example in {folder}")
        for file in files:
            count += 1
            reason = schemas.complaint(f"{kind}.schema.json", load(file))
            if reason:
                faults.append(f"{file.relative_to(data)}: {reason}")
    known = {data / folder for folder in kinds} | {data / "schema"}
    for file in sorted(data.rglob("*.json")):
        if file.parent in known:
            continue
        count += 1
        recorded = (any(data / folder in file.parents for folder in ("records", "reference"))
                    and f"{file.stem}.schema.json" in schemas.each)
        reason = schemas.complaint(f"{file.stem}.schema.json", load(file)) if recorded else "under no schema"
        if reason:
            faults.append(f"{file.relative_to(data)}: {reason}")
    tables = [(file, file.stem.split(".")[0].split("-")[0]) for file in sorted((data / "memory").rglob("*.csv"))]
    for folder in ("moduli", "bench/amplitude-9261"):
        tables += [(file, "moduli") for file in sorted((data / folder).glob("*.csv"))]
    tables += [(file, "moduli") for file in sorted((data / "records").rglob("moduli.csv"))]
    for file, kind in tables:
        count += 1
        for row in rows_of(file):
            reason = schemas.complaint(f"{kind}.schema.json", row)
            if reason:
                faults.append(f"{file.relative_to(data)}: {reason}")
                break
    return faults, count


def edited(document, case):
    """The base document with the changes of a case: JSON Pointers to set and to remove."""
    holder = {"": copy.deepcopy(document)}

    def parent(pointer):
        node, last = holder, ""
        for step in pointer.split("/")[1:]:
            node, last = node[last], int(step) if step.isdigit() else step
        return node, last

    for pointer in case.get("remove", []):
        node, last = parent(pointer)
        del node[last]
    for pointer, value in case.get("set", {}).items():
        node, last = parent(pointer)
        if isinstance(node, list) and last == "-":
            node.append(value)
        else:
            node[last] = value
    return holder[""]


def check_documents(schemas, data, files):
    faults, count = [], 0
    for file in files:
        table = load(file)
        base = load(data / table["base"]) if isinstance(table["base"], str) else table["base"]
        for verdict in ("accept", "reject", "reject by program"):
            for case in table[verdict]:
                count += 1
                reason = schemas.complaint(table["schema"], edited(base, case))
                if (reason is not None) != (verdict == "reject"):
                    faults.append(f"{file}: {case['name']}: {verdict}, but the schema says: {reason or 'good'}")
    return faults, count


# What only a reader can refuse, because it compares keys or walks the path; in its words.
BEYOND_A_SCHEMA = (
    "has nothing to do: its target is the state already reached",
    "takes the volume fraction to",
    "makes the path longer than",
    "overdamps the contact of the two smallest grains",
    "preparation.nu: must be > 0.3 and < 1",
    "preparation.nu: must be > 0.45 and < 1",
    "must be preparation.nu =",
    "preparation.frame already chooses the state",
    "must be a segment of the path",
    "so it has no such place",
    "must lie in segment",
    "must be some of the campaign's seeds",
    "must be the name of a test",
    "must be a volume fraction that",
    "the number of segments",
)


def check_mutants(schemas, folder):
    faults, count = [], 0
    for file in sorted(folder.glob("*.json")):
        table = load(file)
        validator = schemas.validator(f"{file.stem}.schema.json")
        for mutant in table["mutants"]:
            count += 1
            good = validator.is_valid(edited(table["bases"][mutant["base"]], mutant))
            if good == (mutant["said"] == ""):
                continue
            if not good or not any(text in mutant["said"] for text in BEYOND_A_SCHEMA):
                change = {key: mutant[key] for key in ("set", "remove") if key in mutant}
                faults.append(f"{file.name}: {change}: the schema says {'good' if good else 'bad'}, "
                              f"the program says {mutant['said'] or 'good'}")
    return faults, count


def rows_of(file):
    """The rows of a record; an empty field is null."""
    with open(file, newline="", encoding="utf-8") as stream:
        for row in csv.DictReader(stream):
            yield {key: float(text) if text else None for key, text in row.items()}


def check_written(schemas, folder):
    faults, count = [], 0
    for file in sorted(folder.rglob("*")):
        kind = file.name.split(".")[0].split("-")[0]
        if file.suffix == ".json":
            documents = [load(file)]
        elif file.suffix == ".csv":
            documents = list(rows_of(file)) or ["no rows"]
        else:
            continue
        count += 1
        for document in documents:
            reason = schemas.complaint(f"{kind}.schema.json", document)
            if reason:
                faults.append(f"{file.relative_to(folder)}: {reason}")
                break
    return faults, count


def main():
    data, what, rest = pathlib.Path(sys.argv[1]), sys.argv[2], [pathlib.Path(arg) for arg in sys.argv[3:]]
    schemas = Schemas(data / "schema")
    checks = {"schemas": lambda: check_schemas(schemas), "examples": lambda: check_examples(schemas, data),
              "documents": lambda: check_documents(schemas, data, rest),
              "written": lambda: check_written(schemas, *rest), "mutants": lambda: check_mutants(schemas, *rest)}
    faults, count = checks[what]()
    if count == 0:
        faults.append("nothing to check")
    print("\n".join(faults) or f"{count} checked")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
