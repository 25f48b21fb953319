// A process that serves or calls, as its arguments specify: `peer.mjs serve PEER`, `peer.mjs call PEER PORT`.

import { peers } from './peers.mjs'

const [does, name, port] = process.argv.slice(2)
const peer = peers[name]

/** Makes `calls` calls, `inFlight` at a time. */
async function drive(call, inFlight, calls) {
  const latencies = new Float64Array(calls)
  let begun = 0
  const caller = async () => {
    while (begun < calls) {
      const index = begun++
      const start = performance.now()
      await call()
      latencies[index] = performance.now() - start
    }
  }
  const start = performance.now()
  await Promise.all(Array.from({ length: inFlight }, caller))
  const seconds = (performance.now() - start) / 1000
  latencies.sort()
  const at = (share) => 1000 * latencies[Math.floor((calls - 1) * share)]
  return { seconds, p50: at(0.5), p99: at(0.99) }
}

const connections = new Map()

/** Returns a connection for windows of this size, or one for all. */
async function connection(inFlight) {
  const window = peer.windows ? inFlight : 1
  if (!connections.has(window)) connections.set(window, await peer.connect(Number(port), window))
  return connections.get(window)
}

let meter
process.on('message', async (message) => {
  if (message === 'begin') {
    meter = process.cpuUsage()
    process.send('begun')
  } else if (message === 'end') {
    const { user, system } = process.cpuUsage(meter)
    process.send(user + system)
  } else {
    const { inFlight, calls } = message
    const call = await connection(inFlight)
    const alone = peer.windows ? 1 : inFlight
    process.send(await drive(call, alone, peer.windows ? Math.ceil(calls / inFlight) : calls))
  }
})
process.on('disconnect', () => process.exit(0))
process.send(does === 'serve' ? await peer.serve() : 'ready')
