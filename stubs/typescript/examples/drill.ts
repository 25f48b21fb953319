// An app for trying out a connection in trouble, which another program causes. It goes on reading while the connection
// is cut, aborts calls, and goes on calling while the robot ends.

import { CallError, Client } from 'fc-protocol'
import { nodePlatform } from 'fc-protocol/node'
import { main, ports } from './support.ts'

const USAGE = `Tries out the connection to a robot: reads while it is cut, gives calls up, calls while the robot ends.

Usage: drill [--host 127.0.0.1] [--command-port PORT] [--gzip-from BYTES]

From "reading" on the connection may be cut; "calling" asks for the robot to be ended.`

/** Calls in flight at a time. */
const AT_ONCE = 64
/** Reads that get a response although the connection is cut. */
const READS = 1000

await main(USAGE, async (args) => {
  const config = { host: args.host, gzip: args.gzip, ...ports(args) }
  {
    await using client = await Client.connect(nodePlatform, config)
    console.log('reading')
    await read(client)
    console.log(`read: ${READS} answered`)
    await giveUp(client)
    console.log(`given up: ${AT_ONCE}, and the next one answered`)
  }

  // A client without reconnecting: its calls end when the robot has ended.
  await using client = await Client.connect(nodePlatform, { ...config, reconnect: null })
  console.log('calling')
  const answered = await callToTheEnd(client)
  console.log(`ended: ${answered} answered, ${AT_ONCE} lost`)
})

/** Runs `AT_ONCE` of them at a time. */
async function all(work: () => Promise<void>): Promise<void> {
  await Promise.all(Array.from({ length: AT_ONCE }, work))
}

/** Each call only reads, so it is sent again after a loss, and every call gets its response. */
async function read(client: Client): Promise<void> {
  let left = READS
  await all(async () => {
    while (left-- > 0) await client.getRobotSn({})
  })
}

/** Sends calls and aborts them before a response can come. The connection stays usable. */
async function giveUp(client: Client): Promise<void> {
  const controller = new AbortController()
  const calls = Array.from({ length: AT_ONCE }, () => client.getRobotSn({}, { signal: controller.signal }))
  controller.abort()
  await Promise.allSettled(calls)
  await client.getRobotSn({})
}

/**
 * Calls until the robot has gone, and returns the number of responses. Every call ends, the last ones because the
 * connection was lost.
 */
async function callToTheEnd(client: Client): Promise<number> {
  let answered = 0
  await all(async () => {
    try {
      for (;;) {
        await client.getRobotSn({})
        answered++
      }
    } catch (problem) {
      if (!(problem instanceof CallError && ['lost', 'closed', 'not_connected'].includes(problem.kind))) throw problem
    }
  })
  return answered
}
