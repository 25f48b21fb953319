// An app that sends its robot to the dock and follows it there.

import { CallError, Client, Reporter, commands, nameOf, schemas, serve } from 'fc-protocol'
import { nodePlatform } from 'fc-protocol/node'

// The robot of this example starts to recharge, and reports its progress.
const server = await serve(
  nodePlatform,
  { startRecharge: () => commands.startRecharge.responseExample() },
  { address: '127.0.0.1', commandPort: 0, dataPort: 0 },
)
const client = await Client.connect(nodePlatform, { host: '127.0.0.1', commandPort: server.commandPort })

// #region follow
try {
  const following = await client.startRecharge({}).follow()
  void drive()
  for await (const next of following) {
    switch (next.is) {
      case 'going': {
        const { rechargeStatus } = next.report.data
        console.log(`on its way: ${nameOf(schemas.RechargeStatus, rechargeStatus) ?? rechargeStatus}`)
        break
      }
      case 'ended':
        console.log('it charges')
        break
      case 'failed':
        console.log(`it cannot: ${next.report.data.errorStatus}`)
        break
      case 'interrupted':
      case 'resumed':
      case 'missed': {
        // Reports sent meanwhile may be lost: query the state.
        const { data } = await client.getRechargeStatus()
        console.log(`now: ${nameOf(schemas.RechargeStatus, data.rechargeStatus) ?? data.rechargeStatus}`)
      }
    }
  }
} catch (error) {
  if (!(error instanceof CallError)) throw error
  console.log(`not begun: ${error.kind}`)
}
// #endregion follow

client.close()
await server.shutdown(1000)

/** The robot's actions meanwhile. */
async function drive(): Promise<void> {
  const reporter = new Reporter(server)
  for (const [rechargeStatus, errorStatus] of [
    [4, 0],
    [1, 0],
    [1, 1],
  ] as const) {
    await reporter.rechargeProgress({ data: { rechargeStatus, errorStatus } })
  }
}
