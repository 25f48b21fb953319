// The parts for browsers: MD5 and gzip without dependencies, and connections over a WebSocket.

import assert from 'node:assert/strict'
import { createHash } from 'node:crypto'
import { test } from 'node:test'
import { gunzipSync, gzipSync } from 'node:zlib'
import { webAlgorithms, webPlatform } from 'fc-protocol/web'
import { nodeAlgorithms } from 'fc-protocol/node'
import { Connection, Framing, dial, md5 } from 'fc-protocol/runtime'
import { bodyOf, echo, framing, pipe, Raw, toy, wire } from './toy.mjs'

const noise = (length) => Uint8Array.from({ length }, (_, index) => (index * 2654435761) >>> 13)

test('MD5 agrees with Node.js around block lengths', () => {
  for (const length of [...Array(200).keys(), 4096, 100_001]) {
    const data = noise(length)
    assert.deepEqual(Buffer.from(md5(data)), createHash('md5').update(data).digest(), String(length))
  }
  assert.deepEqual(
    Buffer.from(md5(noise(300).subarray(3, 90))),
    createHash('md5').update(noise(300).subarray(3, 90)).digest(),
  )
})

test('gzip packs and unpacks up to its limit', async () => {
  for (const data of [new Uint8Array(), noise(10), new Uint8Array(1 << 20)]) {
    const packed = await webAlgorithms.gzip(data)
    assert.deepEqual(new Uint8Array(gunzipSync(packed)), data)
    assert.deepEqual(await webAlgorithms.gunzip(gzipSync(data), data.length), data)
  }
  const bomb = gzipSync(new Uint8Array(50 << 20))
  assert.equal(await webAlgorithms.gunzip(bomb, 1 << 20), 'inflated_too_long')
  for (const broken of [bomb.subarray(0, -9), noise(100), Buffer.concat([gzipSync('a'), Buffer.from('more')])]) {
    assert.equal(await webAlgorithms.gunzip(broken, 1 << 30), 'bad_gzip')
  }
})

test('frames are the same with either, packed or not', async () => {
  const web = new Framing(wire.frame, wire.defaults.limits, webAlgorithms)
  const id = { response: false, kind: 1, code: 100, id: 7 }
  const data = new TextEncoder().encode(`{"text":"${'x'.repeat(3000)}"}`)
  assert.deepEqual(web.encode(id, data, null), framing.encode(id, data, null))
  const packed = await web.encode(id, data, 100)
  assert.ok(packed.length < 200)
  assert.deepEqual(new Uint8Array(framing.open(packed).data), data)
  assert.deepEqual((await web.open(framing.encode(id, data, 100))).data, data)
})

test('a large inflation is refused except in a stream', async () => {
  const limits = { frameBytes: 1 << 20, inflatedBytes: 64 << 20, inflateRatio: 100 }
  for (const algorithms of [nodeAlgorithms, webAlgorithms]) {
    const strict = new Framing(wire.frame, limits, algorithms)
    const judge = async (kind, length) =>
      (await strict.open(await strict.encode({ response: false, kind, code: 1, id: 1 }, new Uint8Array(length), 0)))
        .fault
    assert.equal(await judge(1, 1 << 20), null)
    assert.equal(await judge(1, 8 << 20), 'inflates_too_much')
    assert.equal(await judge(0, 8 << 20), null)
  }
})

/** A WebSocket that is one end of a pipe. */
class Socket {
  static last = null
  bufferedAmount = 0
  listeners = { open: [], error: [], close: [], message: [] }

  constructor(url) {
    this.url = url
    const [ours, theirs] = pipe()
    this.end = ours
    this.raw = new Raw(theirs)
    Socket.last = this
    queueMicrotask(() => this.tell(url.includes('gone') ? 'error' : 'open'))
    void this.pump()
  }

  async pump() {
    for (;;) {
      const chunk = await this.end.read().catch(() => null)
      if (chunk === null) return this.tell('close')
      this.tell('message', { data: chunk.slice().buffer })
    }
  }

  tell(type, event) {
    for (const listener of this.listeners[type]) listener(event)
  }

  addEventListener(type, listener) {
    this.listeners[type].push(listener)
  }

  send(bytes) {
    void this.end.write(bytes)
  }

  close() {
    this.end.close()
    this.tell('close')
  }
}

/** Makes connections over WebSockets that are pipes, while a test runs. */
function useSockets(context) {
  const before = globalThis.WebSocket
  globalThis.WebSocket = Socket
  context.after(() => {
    globalThis.WebSocket = before
  })
}

test('socket_that_is_not_read_is_closed_beyond_its_limit', async (context) => {
  useSockets(context)
  const { signal } = new AbortController()
  const transport = await webPlatform(() => 'wss://bridge').connect('robot', 1, { keepalive: null, signal })
  const piece = new ArrayBuffer(1 << 20)
  for (let count = 0; count < 64; count++) Socket.last.tell('message', { data: piece })
  assert.equal((await transport.read()).length, 1 << 20)
  Socket.last.tell('message', { data: piece })
  assert.ok(!Socket.last.end.isBroken)
  Socket.last.tell('message', { data: piece })
  assert.ok(Socket.last.end.isBroken)
  await assert.rejects(transport.read(), { name: 'TransportError', reason: 'UNREAD' })
  await assert.rejects(transport.write(new Uint8Array(1)), { name: 'TransportError' })
})

test('a client runs over a WebSocket', async (context) => {
  useSockets(context)
  const platform = webPlatform((host, port) => `wss://bridge/${host}/${port}`)
  const connection = new Connection(await dial(toy, platform, { gzip: { fromBytes: 10 } }))
  const { raw, url } = Socket.last
  assert.equal(url, 'wss://bridge/nowhere/1')
  const call = connection.call(echo, { text: 'x'.repeat(500) })
  while (raw.got.length === 0) await new Promise((resolve) => setImmediate(resolve))
  const [frame] = raw.take()
  assert.ok(frame.sent < 100)
  await raw.sendBytes(
    framing.encode(
      { ...frame.id, response: true },
      new TextEncoder().encode(JSON.stringify({ result: 0, text: bodyOf(frame).text })),
      10,
    ),
  )
  assert.equal((await call).text.length, 500)
  connection.close()
  await connection.closed()
  await assert.rejects(dial(toy, platform, { host: 'gone' }), { name: 'ConnectError', kind: 'io' })
})
