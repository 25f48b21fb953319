"""A tool for the field, without `async`: reads a robot's serial number and state.

./run ask --host 127.0.0.1
"""

from __future__ import annotations

import sys

import fc
import fc_runtime as rt
from common import arguments, client_config


# region ask
def ask(config: rt.ClientConfig) -> None:
    """Prints the robot's facts."""
    with fc.sync.Client.connect(config) as client:
        print("robot", client.get_robot_sn().data.robot_sn)
        match client.get_recharge_status().data.recharge_status:
            case rt.Unknown(value):
                print("charging state", value, "which this version does not know")
            case status:
                print("charging state", status.name.lower())
        try:
            faults = client.list_faults(timeout=10)
        except rt.RefusedError as error:
            # 机器人拒绝了；没有应答、断线等另有各自的错误类。
            # The robot has refused. A timeout, a loss and so on have separate error classes.
            print("faults: refused with", error.refusal.code)
        else:
            print("faults", faults.to_json())


# endregion ask

if __name__ == "__main__":
    config = client_config(arguments("Asks a robot who it is and how it does."))
    try:
        ask(config)
    except (rt.ConnectError, rt.CallError) as error:
        sys.exit(str(error))
