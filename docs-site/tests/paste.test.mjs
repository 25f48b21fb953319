// What engineers paste, as their tools print it: `pastes/forms.json` has each form with the bytes in it,
// or with what the refusal must name.

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

test('what the laboratory writes it reads', () => {
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

test('a paste of half a million bytes is read, and taken apart', () => {
  const operation = protocol.operations.find(({ kind, code }) => kind === 'command' && code !== null)
  const frame = lab.messageFrame(codec, operation, { side: 'request', id: 1, gzip: false }, operation.requestExample)
  const bytes = new Uint8Array(500_000)
  for (let at = 0; at + frame.length <= bytes.length; at += frame.length) bytes.set(frame, at)
  // Anything that grows with the square of the length does not come back from this.
  const { segments } = lab.readPaste(lab.hex(bytes), heads)
  assert.equal(lab.readCapture(codec, segments).sound, Math.floor(bytes.length / frame.length))
})
