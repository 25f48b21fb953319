"""Compares the values that five YAML readers read in the given files: all must be the same.

One reader returns a day as a text, another as a date. Both are equal here, in the form of ISO 8601.
"""

import datetime
import json
import subprocess
import sys
import tempfile

import ruamel.yaml
import yaml

# Values that the readers read differently by design: the comparison must notice them.
DIFFERENT = ["a: on\n", "a: 12:30:00\n", "a: 1_000\n", "a: 0o17\n", "{ a: i64? }\n", "a: 1e3\n"]


def plain(value):
    """Returns a value in the form of JSON, with the keys as texts."""
    if isinstance(value, dict):
        return {str(plain(key)): plain(item) for key, item in value.items()}
    if isinstance(value, list):
        return [plain(item) for item in value]
    if type(value) is datetime.date:
        return value.isoformat()
    if isinstance(value, float) and value.is_integer():
        return int(value)
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    return repr(value)


def read(reader, path):
    with open(path, encoding="utf-8") as file:
        text = file.read()
    try:
        return {"value": plain(reader(text))}
    except Exception as error:  # each reader has exceptions of its own
        return {"refused": " ".join(str(error).split())}


def outside(command, paths):
    """Returns a program's output for the files: one JSON object by path and reader."""
    out = subprocess.run([*command, *paths], check=True, stdout=subprocess.PIPE).stdout
    return json.loads(out)


def readings(mjs, tree, paths):
    """Returns the value of each reader, by path."""
    others = outside(["node", mjs], paths)
    ours = outside([tree], paths)
    for path in paths:
        found = {
            "PyYAML": read(yaml.safe_load, path),
            "ruamel.yaml": read(ruamel.yaml.YAML(typ="safe", pure=True).load, path),
        }
        for name, reading in {**others[path], **ours[path]}.items():
            found[name] = {key: plain(value) for key, value in reading.items()}
        yield path, found


def difference(one, other, place=""):
    """Returns the first difference between two values."""
    if isinstance(one, dict) and isinstance(other, dict) and one.keys() == other.keys():
        pairs = ((key, one[key], other[key]) for key in one)
    elif isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        pairs = ((at, one[at], other[at]) for at in range(len(one)))
    elif type(one) is type(other) and one == other:
        return None
    else:
        return f"{place or '/'}: {one!r} and {other!r}"
    found = (difference(one, other, f"{place}/{key}") for key, one, other in pairs)
    return next(filter(None, found), None)


def disagreements(found):
    """Returns a line for each reader that fails, or that differs from the first one."""
    lines = [f"{name}: {reading['refused']}" for name, reading in found.items() if "refused" in reading]
    accepted = [(name, reading["value"]) for name, reading in found.items() if "refused" not in reading]
    for name, value in accepted[1:]:
        differs = difference(accepted[0][1], value)
        if differs:
            lines.append(f"{accepted[0][0]} and {name} differ at {differs}")
    return lines


def main():
    mjs, tree, *paths = sys.argv[1:]
    with tempfile.TemporaryDirectory() as directory:
        samples = [f"{directory}/{at}.yaml" for at in range(len(DIFFERENT))]
        for path, text in zip(samples, DIFFERENT):
            with open(path, "w", encoding="utf-8") as file:
                file.write(text)
        for (_, found), text in zip(readings(mjs, tree, samples), DIFFERENT):
            if not disagreements(found):
                sys.exit(f"yaml-readers: {text!r} is read differently, and the comparison does not see it")

    faults = 0
    for path, found in readings(mjs, tree, paths):
        for line in disagreements(found):
            faults += 1
            print(f"{path}: {line}", file=sys.stderr)
    if faults:
        sys.exit(f"yaml-readers: {faults} differences")
    print(f"yaml-readers: {len(paths)} files read the same in {len(found)} readers")


main()
