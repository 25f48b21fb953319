"""How the mutants of a run of cargo-mutants were noticed: `noticed.py mutants.out`."""

import json
import pathlib
import re
import sys

# The time limit of a test, in seconds: see fc-test.
LIMIT = 60

out = pathlib.Path(sys.argv[1])
found = {"by an assertion": [], "by the time limit of a test": [], "by hanging": [], "not": []}
unviable = 0
for outcome in json.loads((out / "outcomes.json").read_text())["outcomes"]:
    if outcome["scenario"] == "Baseline":
        continue
    name = outcome["scenario"]["Mutant"]["name"]
    summary = outcome["summary"]
    if summary == "Unviable":
        unviable += 1
    elif summary == "Timeout":
        found["by hanging"].append(name)
    elif summary == "MissedMutant":
        found["not"].append(name)
    else:
        log = (out / outcome["log_path"]).read_text(errors="replace")
        # Of several tests that have failed, one that did so in less than its time counts.
        failed = re.findall(r"FAIL \[ *([\d.]+)s\]", log)
        late = failed and min(map(float, failed)) >= LIMIT
        found["by the time limit of a test" if late else "by an assertion"].append(name)

viable = sum(map(len, found.values()))
print(f"{viable} viable mutants, and {unviable} that do not compile")
for how, names in found.items():
    print(f"{len(names):>5} noticed {how}" if how != "not" else f"{len(names):>5} not noticed")
for how in ("by the time limit of a test", "by hanging", "not"):
    for name in found[how]:
        print(f"{how}: {name}")
