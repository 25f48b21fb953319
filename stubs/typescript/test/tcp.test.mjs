// The package's client and robot over TCP, with the protocol of the spec.

import assert from 'node:assert/strict'
import { once } from 'node:events'
import net from 'node:net'
import { test } from 'node:test'
import { CallError, Client, commands, ExampleRobot, Fc, Reporter, serve } from 'fc-protocol'
import { nodePlatform } from 'fc-protocol/node'
import { Framing } from 'fc-protocol/runtime'

const LOCAL = '127.0.0.1'

async function both(context, robot, { client = {}, server = {} } = {}) {
  const serving = await serve(nodePlatform, robot, { address: LOCAL, commandPort: 0, dataPort: 0, ...server })
  const ports = { host: LOCAL, commandPort: serving.commandPort, dataPort: serving.dataPort }
  const app = await Client.connect(nodePlatform, { ...ports, ...client })
  context.after(async () => {
    app.close()
    await serving.close()
  })
  return { server: serving, app, ports }
}

/** Returns a proxy in front of a port, whose connections a test can cut. */
async function proxy(context, port) {
  const sockets = new Set()
  const listener = net.createServer((near) => {
    const far = net.connect(port, LOCAL)
    for (const [from, to] of [
      [near, far],
      [far, near],
    ]) {
      sockets.add(from)
      from.on('error', () => to.destroy())
      from.on('close', () => to.destroy())
      from.pipe(to)
    }
  })
  listener.listen(0, LOCAL)
  await once(listener, 'listening')
  const cut = () => {
    for (const socket of sockets) socket.resetAndDestroy()
    sockets.clear()
  }
  context.after(() => {
    cut()
    listener.close()
  })
  return { port: listener.address().port, cut }
}

test('a thousand calls at once get their own responses', async (context) => {
  const robot = { getStation: (request) => ({ ...commands.getStation.responseExample(), extra: request.extra }) }
  const gzip = { fromBytes: 64 }
  const { app } = await both(context, robot, { client: { gzip, limits: { inFlight: 1000 } }, server: { gzip } })
  const ask = async (number) => {
    const text = JSON.stringify(`${number}`.repeat(100))
    const { extra } = await app.getStation({
      ...commands.getStation.requestExample(),
      extra: [{ key: 'echo', json: text }],
    })
    assert.deepEqual(extra, [{ key: 'echo', json: text }])
  }
  await Promise.all(Array.from({ length: 1000 }, (_, number) => ask(number)))
})

test('a command is followed over a loss in the middle', async (context) => {
  const { server, ports, app: other } = await both(context, new ExampleRobot({ pretendMotion: true }))
  other.close()
  while (server.connections().length > 0) await new Promise((resolve) => setImmediate(resolve))
  const between = await proxy(context, server.commandPort)
  const app = await Client.connect(nodePlatform, {
    ...ports,
    commandPort: between.port,
    reconnect: { first: 1, longest: 5 },
  })
  context.after(() => app.close())
  const reporter = new Reporter(server)
  const status = (rechargeStatus, errorStatus = 0) => ({ data: { rechargeStatus, errorStatus } })
  const following = await app.startRecharge({}).follow()
  await reporter.rechargeProgress(status(4))
  between.cut()
  const seen = []
  for await (const next of following) {
    seen.push(next.is)
    // The robot recognises the app again after a request.
    if (next.is === 'resumed') void app.getRechargeStatus({}).then(() => reporter.rechargeProgress(status(1, 1)))
  }
  assert.deepEqual(seen, ['going', 'interrupted', 'resumed', 'failed'])
})

test('a loss ends what moves, and repeats what reads', async (context) => {
  let asked = 0
  const robot = {
    getRobotSn: () => (++asked === 1 ? new Promise(() => {}) : commands.getRobotSn.responseExample()),
    startRecharge: () => new Promise(() => {}),
  }
  const { server, ports } = await both(context, robot)
  const between = await proxy(context, server.commandPort)
  const app = await Client.connect(nodePlatform, {
    ...ports,
    commandPort: between.port,
    reconnect: { first: 1, longest: 5 },
  })
  context.after(() => app.close())
  const moves = app.startRecharge({})
  const reads = app.getRobotSn({})
  while (asked === 0) await new Promise((resolve) => setImmediate(resolve))
  between.cut()
  await assert.rejects(moves, { kind: 'lost' })
  assert.ok((await reads).data.robotSn.length > 0)
  assert.equal(asked, 2)
})

test('a shutdown under load answers all that was begun', async (context) => {
  const ends = []
  const robot = {
    getRobotSn: () => new Promise((resolve) => ends.push(() => resolve(commands.getRobotSn.responseExample()))),
  }
  const { server, app } = await both(context, robot, { client: { reconnect: null } })
  const calls = Array.from({ length: 50 }, () =>
    app.getRobotSn({}).then(
      () => 'answered',
      (error) => error.kind,
    ),
  )
  while (ends.length < 50) await new Promise((resolve) => setImmediate(resolve))
  const over = server.shutdown(5000)
  for (const end of ends) end()
  assert.deepEqual([...new Set(await Promise.all(calls))], ['answered'])
  await over
  assert.equal((await app.closed()).is, 'closed_by_robot')
  await assert.rejects(app.getRobotSn({}), (error) => error instanceof CallError && error.kind === 'closed')
})

test('a large picture arrives whole, compressed or not', async (context) => {
  for (const gzip of [null, {}]) {
    const { server, app } = await both(context, new ExampleRobot(), { server: { gzip } })
    const data = app.data()
    await data.connected()
    await app.getRobotSn({})
    const picture = Uint8Array.from({ length: 8 << 20 }, (_, index) => (index * 2654435761) >>> 11)
    const [{ connection }] = server.connections()
    const [frame, taken] = await Promise.all([data.recv(), server.sendBytes(connection, 0x111, 5, picture)])
    assert.equal(taken, 1)
    assert.ok(Buffer.from(frame.data).equals(Buffer.from(picture)))
  }
})

test('hostile apps harm no other app', async (context) => {
  const { server, app, ports } = await both(context, new ExampleRobot())
  const send = async (bytes) => {
    const socket = net.connect(ports.commandPort, LOCAL)
    socket.on('error', () => {})
    socket.write(bytes)
    socket.resume()
    return socket
  }
  const garbage = await send(Buffer.alloc(100_000, 7))
  await once(garbage, 'close')
  const http = await send('GET / HTTP/1.1\r\nHost: robot\r\n\r\n')
  await once(http, 'close')
  const raw = await app.callRaw(commands.getRobotSn.code, `{"x":${'['.repeat(60)}${']'.repeat(60)}}`)
  assert.equal(raw.refusal, null)
  await assert.rejects(app.callRaw(commands.getRobotSn.code, `{"x":${'['.repeat(100_000)}`), {
    kind: 'invalid_request',
  })
  const half = await send(Buffer.from([0xfc, 0xaa]))
  half.destroy()
  assert.ok((await app.getRobotSn({})).data.robotSn.length > 0)
  while (server.connections().length > 1) await new Promise((resolve) => setImmediate(resolve))
  assert.ok(server.counters().badFrames >= 2)
})

test('a_small_frame_of_many_lists_stops_at_the_limit', async (context) => {
  const { server, app, ports } = await both(context, new ExampleRobot())
  const framing = new Framing(Fc.wire.frame, Fc.wire.defaults.limits, nodePlatform.algorithms)
  const lists = `"a":${'['.repeat(40)}${']'.repeat(40)},`
  const body = new TextEncoder().encode(`{${lists.repeat(158_000)}"a":1}`)
  const id = { response: false, kind: framing.kind('command'), code: commands.getRobotSn.code, id: 1 }
  const frame = framing.encode(id, body, 0)
  assert.ok(frame.length < 140_000 && body.length > 13_000_000, `${frame.length} ${body.length}`)
  const socket = net.connect(ports.commandPort, LOCAL)
  socket.write(frame)
  const [answer] = await once(socket, 'data')
  assert.match(answer.toString(), /too_many_values/)
  assert.equal(server.counters().callsInvalid, 1)
  assert.ok((await app.getRobotSn({})).data.robotSn.length > 0)
  socket.destroy()
})

test('`await using` and `close` leave nothing behind', async () => {
  const server = await serve(nodePlatform, new ExampleRobot(), { address: LOCAL, commandPort: 0, dataPort: 0 })
  const app = await Client.connect(nodePlatform, {
    host: LOCAL,
    commandPort: server.commandPort,
    dataPort: server.dataPort,
  })
  await app.getRobotSn({})
  await app[Symbol.asyncDispose]()
  assert.equal(app.state.is, 'closed')
  await server[Symbol.asyncDispose]()
  await assert.rejects(Client.connect(nodePlatform, { host: LOCAL, commandPort: server.commandPort }), {
    kind: 'io',
    reason: 'ECONNREFUSED',
  })
})
