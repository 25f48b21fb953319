import sys

import fc
import fc_runtime as rt
from fc.sync import Client

with Client.connect(rt.ClientConfig(host="127.0.0.1", command_port=int(sys.argv[1]))) as client:
    print(client.get_robot_sn(fc.GetRobotSnRequest()).data.robot_sn)
