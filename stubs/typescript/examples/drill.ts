// An app for trying out a connection under trouble that somebody else makes: reads on while the connection is cut, gives calls up,
// and calls on while the robot ends.

import { CallError, Client } from 'fc-protocol'
import { nodePlatform } from 'fc-protocol/node'
import { main, ports } from './support.ts'

const USAGE = `Tries out the connection to a robot: reads while it is cut, gives calls up, calls while the robot ends.

Usage: drill [--host 127.0.0.1] [--command-port PORT] [--gzip-from BYTES]

From "reading" on the connection may be cut; "calling" asks for the robot to be ended.`

/** Calls in flight at a time. */
const AT_ONCE = 64
/** Reads that are to be answered though the connection is cut. */
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

  // Another one, which does not come back: that the robot has ended ends its calls.
  await using client = await Client.connect(nodePlatform, { ...config, reconnect: null })
  console.log('calling')
  const answered = await callToTheEnd(client)
  console.log(`ended: ${answered} answered, ${AT_ONCE} lost`)
})

/** So many of them at a time. */
async function all(work: () => Promise<void>): Promise<void> {
  await Promise.all(Array.from({ length: AT_ONCE }, work))
}

/** Each call is a read, so it is sent again after a loss, and every single one is answered. */
async function read(client: Client): Promise<void> {
  let left = READS
  await all(async () => {
    while (left-- > 0) await client.getRobotSn({})
  })
}

/** Sends calls and aborts them before an answer can have come; the connection serves on. */
async function giveUp(client: Client): Promise<void> {
  const controller = new AbortController()
  const calls = Array.from({ length: AT_ONCE }, () => client.getRobotSn({}, { signal: controller.signal }))
  controller.abort()
  await Promise.allSettled(calls)
  await client.getRobotSn({})
}

/**
 * Calls until the robot has gone, and tells how many were answered. Every call has an end, and the end of the last ones says that
 * the connection was lost.
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
