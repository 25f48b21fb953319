// Pasted text, in the forms that engineers' tools print. `pastes/forms.json` has each form with its bytes, or with the
// words that the refusal must contain.

import assert from 'node:assert/strict'
import { execFileSync } from 'node:child_process'
import { readFileSync } from 'node:fs'
import { test } from 'node:test'
import { engine } from './support.mjs'

const lab = await engine()
const { codec, protocol } = lab
const heads = [protocol.requestHead, protocol.responseHead]
const forms = JSON.parse(readFileSync(new URL('pastes/forms.json', import.meta.url), 'utf8'))

for (const { name, text, segments, spelling, refused } of forms) {
  test(`${name}: ${refused === undefined ? 'read' : 'refused with the reason'}`, () => {
    if (refused !== undefined) {
      assert.throws(() => lab.readPaste(text, heads), (problem) => {
        assert.ok(problem instanceof lab.Refusal, String(problem))
        for (const words of Object.values(problem.text)) assert.ok(words.includes(refused), `${words} does not name ${refused}`)
        return true
      })
      return
    }
    const read = lab.readPaste(text, heads)
    assert.deepEqual(
      read.segments.map(({ stream, bytes }) => ({ stream, hex: Buffer.from(bytes).toString('hex') })),
      segments,
    )
    if (spelling !== undefined) assert.equal(read.spelling, spelling)
  })
}

test('the laboratory reads its own output', () => {
  const bytes = Uint8Array.from({ length: 256 }, (_, byte) => byte)
  for (const text of [lab.hex(bytes), lab.cArray(bytes, 'f'), lab.ncLine(bytes, '127.0.0.1', 1)]) {
    assert.deepEqual(lab.readPaste(text, heads).segments, [{ stream: 0, bytes }], text)
  }
})

test('the nc line is the frame, spelled for printf', () => {
  const bytes = Uint8Array.from({ length: 256 }, (_, byte) => byte)
  const line = lab.ncLine(bytes, '127.0.0.1', 1).split(' | ')[0]
  assert.deepEqual(new Uint8Array(execFileSync('sh', ['-c', line])), bytes)
})

test('too much text is refused before it is read', () => {
  assert.throws(() => lab.readPaste(' '.repeat(lab.PASTE_LIMIT + 1), heads), lab.Refusal)
})

test('a paste of half a million bytes is decoded', () => {
  const operation = protocol.operations.find(({ kind, code }) => kind === 'command' && code !== null)
  const frame = lab.messageFrame(codec, operation, { side: 'request', id: 1, gzip: false }, operation.requestExample)
  const bytes = new Uint8Array(500_000)
  for (let at = 0; at + frame.length <= bytes.length; at += frame.length) bytes.set(frame, at)
  // A quadratic search would not end within the time limit.
  const { segments } = lab.readPaste(lab.hex(bytes), heads)
  assert.equal(lab.readCapture(codec, segments).sound, Math.floor(bytes.length / frame.length))
})

/** Bytes of numbers: `[value, size]`, in one byte order. */
const numbers = (little, ...pairs) =>
  pairs.flatMap(([value, size]) => {
    const bytes = Array.from({ length: size }, (_, at) => Number((BigInt(value) >> BigInt(8 * at)) & 0xffn))
    return little ? bytes : bytes.reverse()
  })

const APP = [[192, 168, 1, 20], 40000]
const ROBOT = [[192, 168, 1, 10], 5656]
const DATA = 0x18
const SYN = 0x02

/** An IP packet with a TCP segment. */
function packet([from, fromPort], [to, toPort], sequence, payload, flags = DATA) {
  const tcp = [...numbers(false, [fromPort, 2], [toPort, 2], [sequence, 4], [0, 4]), 0x50, flags, ...numbers(false, [512, 2], [0, 4]), ...payload]
  const ip = (protocol, inside) => [0x45, 0, ...numbers(false, [20 + inside.length, 2], [7, 2], [0x4000, 2]), 64, protocol, 0, 0, ...from, ...to, ...inside]
  return ip(6, tcp)
}
const udp = [0x45, 0, 0, 28, 0, 0, 0, 0, 64, 17, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 0, 53, 0, 53, 0, 8, 0, 0]

/** Link-layer frames around an IP packet, by link type. */
const LINKS = {
  0: (ip) => [2, 0, 0, 0, ...ip],
  1: (ip) => [...Array(12).fill(1), 8, 0, ...ip, ...Array(6).fill(0)],
  101: (ip) => ip,
  113: (ip) => [...Array(14).fill(0), 8, 0, ...ip],
  276: (ip) => [8, 0, ...Array(18).fill(0), ...ip],
}
const vlan = (ip) => [...Array(12).fill(1), 0x81, 0, 0, 5, 8, 0, ...ip]

function pcap(packets, { little = true, link = 1, magic = 0xa1b2c3d4, wrap = LINKS[link], extra = 0 } = {}) {
  const n = (...pairs) => numbers(little, ...pairs)
  const record = (bytes) => [...n([0, 4], [0, 4], [bytes.length, 4], [bytes.length, 4]), ...Array(extra).fill(0), ...bytes]
  return Uint8Array.from([...n([magic, 4], [2, 2], [4, 2], [0, 4], [0, 4], [65535, 4], [link, 4]), ...packets.flatMap((ip) => record(wrap(ip)))])
}

function pcapng(packets, { little = true, link = 1, simple = false } = {}) {
  const n = (...pairs) => numbers(little, ...pairs)
  const block = (kind, body) => {
    const padded = [...body, ...Array((4 - (body.length % 4)) % 4).fill(0)]
    return [...n([kind, 4], [padded.length + 12, 4]), ...padded, ...n([padded.length + 12, 4])]
  }
  const enhanced = (bytes) => block(6, [...n([0, 4], [0, 4], [0, 4], [bytes.length, 4], [bytes.length, 4]), ...bytes])
  const short = (bytes) => block(3, [...n([bytes.length, 4]), ...bytes])
  return Uint8Array.from([
    ...block(0x0a0d0d0a, n([0x1a2b3c4d, 4], [1, 2], [0, 2], [0xffffffffffffffffn, 8])),
    ...block(1, n([link, 2], [0, 2], [65535, 4])),
    ...block(5, n([0, 4], [0, 4], [0, 4])),
    ...packets.flatMap((ip) => (simple ? short : enhanced)(LINKS[link](ip))),
  ])
}

const operation = protocol.operations.find(({ kind, code }) => kind === 'command' && code !== null)
const frame = (side) => [...lab.messageFrame(codec, operation, { side, id: 7, gzip: false }, operation[`${side}Example`])]
const [request, response] = [frame('request'), frame('response')]
const half = response.slice(0, 50)
const rest = response.slice(50)
const opening = [packet(APP, ROBOT, 999, [], SYN), packet(ROBOT, APP, 4999, [], SYN)]
const TALK = [...opening, udp, packet(APP, ROBOT, 1000, request), packet(ROBOT, APP, 5000, half), packet(ROBOT, APP, 5050, rest)]
const web = packet([[10, 0, 0, 1], 50000], [[10, 0, 0, 2], 80], 1, [...Buffer.from('GET / HTTP/1.1')])

/** Name, file, the bytes of each stream. */
const FILES = [
  ...Object.keys(LINKS).map((link) => [`pcap, link ${link}`, pcap(TALK, { link: Number(link) })]),
  ['pcap, most significant byte first', pcap(TALK, { little: false })],
  ['pcap, nanoseconds', pcap(TALK, { magic: 0xa1b23c4d })],
  ['pcap, longer records', pcap(TALK, { magic: 0xa1b2cd34, extra: 8 })],
  ['pcap, with a VLAN', pcap(TALK, { wrap: vlan })],
  ['pcap, cut inside a packet', Uint8Array.from([...pcap(TALK), ...Array(20).fill(9)])],
  ['pcap, with other traffic', pcap([web, ...TALK, web])],
  ['pcap, a packet sent again', pcap([...TALK.slice(0, 5), TALK[4], TALK[5]])],
  ['pcap, packets out of order', pcap([...TALK.slice(0, 4), TALK[5], TALK[4]])],
  ['pcap, sequence numbers that begin anew', pcap([...TALK.slice(0, 4), packet(ROBOT, APP, 0xfffffff0, [], SYN), packet(ROBOT, APP, 0xfffffff1, half), packet(ROBOT, APP, (0xfffffff1 + 50) % 2 ** 32, rest)])],
  ['pcapng', pcapng(TALK)],
  ['pcapng, most significant byte first', pcapng(TALK, { little: false })],
  ['pcapng, simple packets', pcapng(TALK, { simple: true })],
  ['pcapng, two sections', Uint8Array.from([...pcapng(TALK.slice(0, 4), { little: false }), ...pcapng(TALK.slice(4), { link: 101 })])],
]

/** The bytes of each stream, one after the other. */
function streams(segments) {
  const all = new Map()
  for (const { stream, bytes } of segments) all.set(stream, [...(all.get(stream) ?? []), ...bytes])
  return [...all.values()]
}

for (const [name, file] of FILES) {
  test(`${name}: its streams are read, opened or pasted`, () => {
    const hex = Buffer.from(file).toString('hex')
    const lines = hex.match(/.{1,32}/g).map((line, at) => `${(16 * at).toString(16).padStart(8, '0')}: ${line.match(/.{1,4}/g).join(' ')}`)
    for (const text of [lab.readFile(file, heads), hex, Buffer.from(file).toString('base64'), lines.join('\n')]) {
      const { segments } = lab.readPaste(text, heads)
      assert.deepEqual(streams(segments), [request, response])
      assert.equal(lab.readCapture(codec, segments).level, 'good')
    }
  })
}

test('a new connection of the same ports is another stream', () => {
  const again = [packet(APP, ROBOT, 70, [], SYN), packet(APP, ROBOT, 71, request)]
  const { segments } = lab.readPaste(lab.readFile(pcap([...TALK, ...again]), heads), heads)
  assert.deepEqual(streams(segments), [request, response, request])
})

test('the rest of a capture with a hole is read', () => {
  const { segments } = lab.readPaste(lab.readFile(pcap([...TALK.slice(0, 4), TALK[5], packet(ROBOT, APP, 5000 + response.length, response)]), heads), heads)
  assert.deepEqual(streams(segments), [request, [...rest, ...response]])
})

test('a capture without frames is refused with its packet count', () => {
  assert.throws(() => lab.readFile(pcap([web, udp]), heads), (problem) => {
    assert.ok(problem instanceof lab.Refusal, String(problem))
    assert.match(problem.text.en, /2 packets, 1 of them TCP/)
    return true
  })
})

test('text files are opened unchanged, bytes as a dump', () => {
  const text = '17:40:01 TX: FC AA\n'
  assert.equal(lab.readFile(Uint8Array.from(Buffer.from(text)), heads), text)
  assert.equal(lab.readFile(Uint8Array.from(Buffer.from(`\ufeff${text}`, 'utf16le')), heads), text)
  const { segments } = lab.readPaste(lab.readFile(Uint8Array.from([...request, ...response]), heads), heads)
  assert.deepEqual(streams(segments), [[...request, ...response]])
  assert.throws(() => lab.readFile(new Uint8Array(lab.FILE_LIMIT + 1), heads), lab.Refusal)
})

test('damaged captures are read up to the damage', () => {
  for (const [, file] of FILES) {
    for (let cut = 0; cut < file.length; cut += 7) {
      const part = file.slice(0, cut)
      const broken = Uint8Array.from(file, (byte, at) => (at === cut ? byte ^ 0xff : byte))
      for (const bytes of [part, broken]) {
        try {
          lab.readPaste(lab.readFile(bytes, heads), heads)
        } catch (problem) {
          assert.ok(problem instanceof lab.Refusal, String(problem))
        }
      }
    }
  }
})
