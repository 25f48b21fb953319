"""Files of the project, and the generated protocol that the tests of the runtime use."""

from __future__ import annotations

import faulthandler
import json
from pathlib import Path
from typing import Any

from fc import FC

ROOT = Path(__file__).resolve().parents[3]

PROTOCOL = FC
LIMITS = FC.defaults.limits


def load(path: str) -> Any:
    return json.loads((ROOT / path).read_text(encoding="utf-8"))


# A test that hangs ends all of them, and says where it hangs.
faulthandler.dump_traceback_later(500, exit=True)
