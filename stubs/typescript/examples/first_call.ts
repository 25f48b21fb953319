// A robot and an app on this machine: the app reads the serial number, and the robot reports the progress of
// recharging.

import { Client, PartialRobot, Refusal, Reporter, ResultCode, nameOf, schemas, serve } from 'fc-protocol'
import type { Answer, Client as App, GetRobotSnResponse, StartRechargeResponse } from 'fc-protocol'
import { nodePlatform } from 'fc-protocol/node'

// #region robot
class Trolley extends PartialRobot {
  override getRobotSn(): Answer<GetRobotSnResponse> {
    return { data: { robotSn: '100132007654321', robotModel: 'Indoor' } }
  }

  override startRecharge(): Answer<StartRechargeResponse> {
    throw new Refusal(ResultCode.InvalidParameter, 'there is no dock here')
  }
}
// #endregion robot

// #region serve
const server = await serve(nodePlatform, new Trolley(), { address: '127.0.0.1', commandPort: 0, dataPort: 0 })
// #endregion serve

// #region connect
const client: App = await Client.connect(nodePlatform, { host: '127.0.0.1', commandPort: server.commandPort })
// #endregion connect

// #region app
const { data } = await client.getRobotSn({}, { timeout: 1000 })
console.log(`app: the robot is ${data.robotSn}`)
// #endregion app

// #region report
const listening = listen(client)
const ended = await new Reporter(server).rechargeProgress({ data: { rechargeStatus: 1, errorStatus: 0 } })
const taken = ended.filter(({ outcome }) => outcome === 'acknowledged').length
console.log(`robot: ${taken} app has acknowledged`)
// #endregion report

await listening
client.close()
await server.shutdown(1000)

/** Takes the first report about recharging. Reports are already acknowledged when they arrive here. */
async function listen(client: App): Promise<void> {
  // #region listen
  for await (const report of client.reports()) {
    if (report.case === 'RechargeProgress') {
      const { rechargeStatus } = report.value.data
      console.log(`app: recharging is at ${nameOf(schemas.RechargeStatus, rechargeStatus) ?? rechargeStatus}`)
      return
    }
  }
  // #endregion listen
}
