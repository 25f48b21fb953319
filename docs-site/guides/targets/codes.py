#!/usr/bin/env python3
"""A target of its own: command codes as a C header. Gets the dump of the spec, answers with files."""
import json
import sys

dump = json.load(sys.stdin)
prefix = dump["options"]["prefix"]

lines = [
    f"/* {dump['protocol']['en']}, version {dump['protocol']['version']}. Made by `fcproto generate`. */",
    f"#ifndef {prefix}_CODES_H",
    f"#define {prefix}_CODES_H",
]
for operation in dump["operations"]:
    if operation["code"] is None:
        continue
    name = f"{prefix}_{operation['name'].upper()}"
    lines += ["", f"/* {operation['en']} */", f"#define {name} 0x{operation['code']:04X}"]
lines += ["", "#endif", ""]

json.dump([{"path": "codes.h", "contents": "\n".join(lines)}], sys.stdout)
