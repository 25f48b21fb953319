"""The golden frames against the frame codec: those of `frames.json`, and the frames around every message."""

from __future__ import annotations

import unittest

import fc_runtime as rt
from support import PROTOCOL, ROOT, holds, load

FRAME_ERRORS = {error["name"] for error in load("conformance/errors.json")["errors"] if error["where"] == "frame"}


def decode(data: bytes, size: int) -> rt.Frame:
    decoder = rt.Decoder(PROTOCOL)
    for start in range(0, len(data), size):
        decoder.push(data[start : start + size])
    frame = decoder.next()
    decoder.finish()
    assert frame is not None
    return frame


class Frames(unittest.TestCase):
    def test_every_golden_frame(self) -> None:
        accepted = rejected = 0
        for path in sorted((ROOT / "fc-generated/vectors").glob("*.json")):
            vectors = load(f"fc-generated/vectors/{path.name}")
            for vector in vectors["accepted"]:
                if "frame" not in vector:
                    continue
                with self.subTest(path.name, name=vector["name"]):
                    data = bytes.fromhex(vector["frame"])
                    frame = decode(data, 4096)
                    self.assertEqual(frame.id.response, vector["direction"] == "response")
                    self.assertEqual(decode(data, 1), frame)
                    if vector["case"] == "plain":
                        self.assertEqual(rt.Encoder(PROTOCOL).encode(frame.id, frame.data), data)
                    packing = rt.Encoder(PROTOCOL, compress=rt.Gzip(from_bytes=0, level=9))
                    self.assertEqual(decode(packing.encode(frame.id, frame.data), 4096).data, frame.data)
                    accepted += 1
                    if path.name == "frames.json":
                        holds("frames")
            for vector in vectors["rejected"]:
                if vector["error"] not in FRAME_ERRORS or "frame" not in vector:
                    continue
                with self.subTest(path.name, name=vector["name"]):
                    with self.assertRaises(rt.FrameError) as caught:
                        decode(bytes.fromhex(vector["frame"]), 4096)
                    self.assertEqual(caught.exception.name, vector["error"])
                    rejected += 1
                    if path.name == "frames.json":
                        holds("frames")
        self.assertGreater(accepted, 300)
        self.assertGreater(rejected, 300)

    def test_garbage_between_frames_is_skipped_with_resync(self) -> None:
        frame = rt.Encoder(PROTOCOL).encode(rt.FrameId(False, 1, 100, 7), b"{}")
        decoder = rt.Decoder(PROTOCOL, resync=True)
        decoder.push(b"garbage" + frame + b"more" + frame)
        found: list[rt.Frame | None] = []
        while len(found) < 2:
            try:
                found.append(decoder.next())
            except rt.FrameError as error:
                self.assertEqual(error.name, "bad_head")
        self.assertEqual([frame and frame.id.id for frame in found], [7, 7])


if __name__ == "__main__":
    unittest.main()
