"""The first error of a body with several, with its place, as in `faults.json`."""

from __future__ import annotations

import unittest

import fc_runtime as rt
from fc_runtime.enveloped import read_with_envelope
from support import LIMITS, PROTOCOL, holds, load

MESSAGES: dict[str, tuple[type[rt.Message], type[rt.Message]]] = {
    **{command.name: (command.request, command.response) for command in PROTOCOL.commands},
    **{report.name: (report.request, report.response) for report in PROTOCOL.reports},
}


class Faults(unittest.TestCase):
    def test_the_first_of_several_is_named(self) -> None:
        faults = load("conformance/faults.json")["faults"]
        self.assertGreater(len(faults), 10)
        for fault in faults:
            request, response = MESSAGES[fault["operation"]]
            is_request = fault["message"] == "request"
            envelope = PROTOCOL.request_envelope if is_request else PROTOCOL.response_envelope
            cls = request if is_request else response
            with self.subTest(fault["name"]):
                with self.assertRaises(rt.BodyError) as caught:
                    _, message = read_with_envelope(envelope, cls, fault["text"].encode(), LIMITS)
                    if isinstance(message, rt.BodyError):
                        raise message
                self.assertEqual(caught.exception.name, fault["error"])
                if "path" in fault:
                    self.assertEqual(caught.exception.path, fault["path"])
                holds("faults")


if __name__ == "__main__":
    unittest.main()
