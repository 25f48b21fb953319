// The example programs end, for any behaviour of their robot.

import assert from 'node:assert/strict'
import { spawn } from 'node:child_process'
import { once } from 'node:events'
import net from 'node:net'
import path from 'node:path'
import { test } from 'node:test'
import { text } from 'node:stream/consumers'
import { ExampleRobot, Fc, serve } from 'fc-protocol'
import { nodePlatform } from 'fc-protocol/node'
import { root } from './support.mjs'

const LOCAL = '127.0.0.1'

/** Serves a robot that responds like the example, and calls back with each request. */
async function serving(context, asked) {
  const example = new ExampleRobot({ pretendMotion: true })
  const robot = new Proxy(example, {
    get: (of, name) => {
      const method = of[name]
      if (typeof method !== 'function') return method
      return (request, call) => {
        asked(call)
        return method.call(of, request, call)
      }
    },
  })
  const server = await serve(nodePlatform, robot, { address: LOCAL, commandPort: 0, dataPort: 0 })
  context.after(() => server.close())
  return server
}

/** Runs an example to its end. */
async function run(context, name, ...args) {
  const program = spawn(process.execPath, [path.join(root, `dist/examples/${name}.js`), ...args], {
    stdio: ['ignore', 'pipe', 'pipe'],
  })
  context.after(() => program.kill())
  const [stdout, stderr, [code]] = await Promise.all([
    text(program.stdout),
    text(program.stderr),
    once(program, 'exit'),
  ])
  return { stdout, stderr, code }
}

test('app_ends_with_1_after_a_failure', async (context) => {
  const sockets = new Set()
  const server = await serving(context, ({ code, connection }) => {
    // At the last command the app has its data connection, which then closes.
    if (code !== Fc.commands.at(-1).code) return
    for (const report of Fc.reports) void server.pushAny(connection, report, report.example())
    for (const socket of sockets) socket.destroy()
  })
  const data = net.createServer((socket) => {
    socket.on('error', () => {})
    sockets.add(socket)
  })
  context.after(() => data.close())
  context.after(() => sockets.forEach((socket) => socket.destroy()))
  data.listen(0, LOCAL)
  await once(data, 'listening')
  const ports = ['--command-port', server.commandPort, '--data-port', data.address().port]
  const { code, stdout, stderr } = await run(context, 'app', ...ports)
  assert.deepEqual([code, stdout], [1, ''])
  assert.match(stderr, /^lost: /)
})

test('drill_ends_with_1_after_a_failure', async (context) => {
  let asked = 0
  const server = await serve(
    nodePlatform,
    {
      getRobotSn: () => {
        asked++
        throw new Error('broken')
      },
    },
    { address: LOCAL, commandPort: 0, dataPort: 0, log: () => {} },
  )
  context.after(() => server.close())
  const { code, stderr } = await run(context, 'drill', '--command-port', server.commandPort)
  assert.equal(code, 1)
  assert.match(stderr, /^the robot has refused: /)
  assert.ok(asked > 0)
})
