"""The names of errors are those of `errors.json`, shared by all implementations."""

from __future__ import annotations

import unittest

import fc_runtime as rt
from fc_runtime import calls
from support import holds, load


class Errors(unittest.TestCase):
    def test_names_are_those_of_the_list(self) -> None:
        listed = load("conformance/errors.json")["errors"]
        for where, own in (
            ("frame", {kind.value for kind in rt.FrameErrorKind}),
            ("body", {kind.value for kind in rt.BodyErrorKind}),
            ("call", {error.name for error in calls.CALL_ERRORS}),
        ):
            here = [error for error in listed if error["where"] == where]
            # A limit that this package does not have.
            self.assertEqual(own, {error["name"] for error in here} - {"lists_too_large"}, where)
            for error in here:
                if not error.get("own_limit"):
                    holds(f"{where}_errors")


if __name__ == "__main__":
    unittest.main()
