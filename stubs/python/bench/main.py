"""Compares the package with JSON and MD5 alone, and with gRPC."""

from __future__ import annotations

import argparse
import json
import os
import platform
import time
from importlib.metadata import version
from pathlib import Path
from typing import Any

from calls import Span, calls
from codec import codec
from measure import Effort

REPORT = Path(__file__).resolve().parents[3] / "bench" / "packages" / "python.json"


def processor() -> str:
    """Returns the processor's name, if the system has one."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.machine()
    return next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), platform.machine())


def digits(value: float | None) -> str:
    """Returns a figure with its significant digits."""
    return "–" if value is None else f"{value:.2f}" if value < 100 else f"{value:.0f}"


def show(report: dict[str, Any]) -> None:
    """Prints the tables."""
    print("Times in microseconds. Floor: JSON and MD5 alone, on the same bytes.\n")
    print(f"{'':8}{'bytes':>8}" + f"{'floor':>10}{'fc':>10}{'× floor':>9}{'messages/s':>12}" * 2)
    for one in report["codec"]:
        print(f"{one['message']:8}{one['bytes']:8}", end="")
        for what in ("decode", "encode"):
            least, fc = one[what]["least"], one[what]["fc"]
            print(f"{digits(least):>10}{digits(fc):>10}{digits(fc / least):>9}{1e6 / fc:12.0f}", end="")
        print()
    print("(first decoded, then encoded)")
    for scenario in report["calls"]:
        grpc = next(peer for peer in scenario["peers"] if peer["name"] == report["grpc"])
        print(f"\nCalls, {scenario['in_flight']} in flight")
        print(f"{'':8}{'calls/s':>10}{'× gRPC':>9}{'p50':>10}{'p99':>10}{'CPU/call':>10}{'CPU × gRPC':>12}")
        for peer in scenario["peers"]:
            print(
                f"{peer['name']:8}{peer['rate']:10.0f}{digits(peer['rate'] / grpc['rate']):>9}{digits(peer['p50']):>10}"
                f"{digits(peer['p99']):>10}{digits(peer['cpu']):>10}{digits(peer['cpu'] / grpc['cpu']):>12}"
            )


def main() -> None:
    """Runs the benchmark, and prints or writes the result."""
    parser = argparse.ArgumentParser(prog="bench/run", description=__doc__)
    either = parser.add_mutually_exclusive_group()
    either.add_argument("--smoke", action="store_true", help="one tiny round: that all works, and no figures to go by")
    either.add_argument("--report", action="store_true", help="write bench/packages/python.json, which the page shows")
    options = parser.parse_args()
    report = {
        "language": "Python",
        "date": time.strftime("%Y-%m-%d", time.gmtime()),
        "processor": processor(),
        "cores": os.cpu_count() or 1,
        "versions": {"Python": platform.python_version(), "grpcio": version("grpcio")},
        "json": "json.loads, JSONEncoder",
        "grpc": "grpcio",
        "goals": {"calls": 2},
        "codec": codec(Effort(1, 0.001) if options.smoke else Effort(31, 0.01)),
        "calls": calls(Span(1, 0.01) if options.smoke else Span(9, 0.2)),
    }
    show(report)
    if options.report:
        REPORT.write_text(json.dumps(report, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
