// Calls over loopback: each peer has a process that serves and one that calls, and the peers take turns.

import { spawn, spawnSync } from 'node:child_process'
import { once } from 'node:events'
import { availableParallelism } from 'node:os'
import { fileURLToPath } from 'node:url'
import { median } from './measure.mjs'
import { peers } from './peers.mjs'

/** Numbers of calls in flight. */
const IN_FLIGHT = [1, 64]

const program = fileURLToPath(new URL('peer.mjs', import.meta.url))
const pins = availableParallelism() > 1 && spawnSync('taskset', ['-c', '0,1', 'true']).status === 0

/** Starts a process on a core, and returns its first line. */
async function start(core, ...words) {
  const command = [...(pins ? ['taskset', '-c', String(core)] : []), process.execPath, program, ...words]
  const child = spawn(command[0], command.slice(1), { stdio: ['ignore', 'inherit', 'inherit', 'ipc'] })
  const ask = async (message) => {
    const answered = once(child, 'message')
    if (message !== undefined) child.send(message)
    return (await answered)[0]
  }
  return { ask, first: await ask(), stop: () => child.disconnect() }
}

/** Starts the server and the caller of a peer. */
async function pair(name) {
  const server = await start(0, 'serve', name)
  const caller = await start(1, 'call', name, String(server.first))
  return { server, caller }
}

/** Runs one round of one peer. Returns its duration and the CPU time of both processes. */
async function round({ server, caller }, inFlight, calls) {
  await server.ask('begin')
  await caller.ask('begin')
  const { seconds, p50, p99 } = await caller.ask({ inFlight, calls })
  const cpu = (await caller.ask('end')) + (await server.ask('end'))
  return { seconds, p50, p99, cpu, rate: calls / seconds, cpuPerCall: cpu / calls }
}

/** Returns the cost of calls for each number in flight, and each peer. */
export async function calls({ rounds, seconds }) {
  const pairs = {}
  try {
    for (const name of Object.keys(peers)) pairs[name] = await pair(name)
    const scenarios = []
    for (const inFlight of IN_FLIGHT) {
      const counts = {}
      for (const name of Object.keys(pairs)) {
        // Warms up, and finds the number of calls for a round.
        let count = 64 * inFlight
        let tried = await round(pairs[name], inFlight, count)
        while (tried.seconds < seconds) tried = await round(pairs[name], inFlight, (count *= 2))
        counts[name] = count
      }
      const found = Object.fromEntries(Object.keys(pairs).map((name) => [name, []]))
      for (let turn = 0; turn < rounds; turn++) {
        for (const name of Object.keys(pairs)) found[name].push(await round(pairs[name], inFlight, counts[name]))
      }
      const middle = (name, of) => median(found[name].map((one) => one[of]))
      scenarios.push({
        in_flight: inFlight,
        peers: Object.keys(pairs).map((name) => ({
          name,
          rate: middle(name, 'rate'),
          // A window of the floor is not a single call, so it has no latency.
          p50: peers[name].windows && inFlight > 1 ? null : middle(name, 'p50'),
          p99: peers[name].windows && inFlight > 1 ? null : middle(name, 'p99'),
          cpu: middle(name, 'cpuPerCall'),
        })),
      })
    }
    return scenarios
  } finally {
    for (const { server, caller } of Object.values(pairs)) {
      caller.stop()
      server.stop()
    }
  }
}
