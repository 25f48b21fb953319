// MD5 (RFC 1321), for platforms that lack it. The protocol uses it as a digest. It gives no protection against an
// attacker.

const SHIFTS = [7, 12, 17, 22, 5, 9, 14, 20, 4, 11, 16, 23, 6, 10, 15, 21]
const SINES = Int32Array.from({ length: 64 }, (_, index) => Math.floor(Math.abs(Math.sin(index + 1)) * 2 ** 32))
const BLOCK = 64

/** The sixteen bytes of the MD5 digest. */
export function md5(data: Uint8Array): Uint8Array {
  const state = Int32Array.of(0x67452301, 0xefcdab89, 0x98badcfe, 0x10325476)
  const whole = data.length - (data.length % BLOCK)
  const words = new Int32Array(16)
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength)
  for (let at = 0; at < whole; at += BLOCK) {
    for (let word = 0; word < 16; word++) words[word] = view.getInt32(at + 4 * word, true)
    mix(state, words)
  }
  const rest = data.length - whole
  const tail = new Uint8Array(rest < BLOCK - 8 ? BLOCK : 2 * BLOCK)
  tail.set(data.subarray(whole))
  tail[rest] = 0x80
  const end = new DataView(tail.buffer)
  end.setUint32(tail.length - 8, (data.length * 8) >>> 0, true)
  end.setUint32(tail.length - 4, Math.floor(data.length / 2 ** 29), true)
  for (let at = 0; at < tail.length; at += BLOCK) {
    for (let word = 0; word < 16; word++) words[word] = end.getInt32(at + 4 * word, true)
    mix(state, words)
  }
  const digest = new Uint8Array(16)
  const out = new DataView(digest.buffer)
  for (let word = 0; word < 4; word++) out.setInt32(4 * word, state[word] ?? 0, true)
  return digest
}

/** Takes one block into the state. */
function mix(state: Int32Array, words: Int32Array): void {
  let a = state[0] ?? 0
  let b = state[1] ?? 0
  let c = state[2] ?? 0
  let d = state[3] ?? 0
  for (let step = 0; step < 64; step++) {
    const round = step >> 4
    let mixed: number
    let word: number
    if (round === 0) {
      mixed = (b & c) | (~b & d)
      word = step
    } else if (round === 1) {
      mixed = (d & b) | (~d & c)
      word = (5 * step + 1) & 15
    } else if (round === 2) {
      mixed = b ^ c ^ d
      word = (3 * step + 5) & 15
    } else {
      mixed = c ^ (b | ~d)
      word = (7 * step) & 15
    }
    const sum = (a + mixed + (SINES[step] ?? 0) + (words[word] ?? 0)) | 0
    const shift = SHIFTS[round * 4 + (step & 3)] ?? 0
    a = d
    d = c
    c = b
    b = (b + ((sum << shift) | (sum >>> (32 - shift)))) | 0
  }
  state[0] = (state[0] ?? 0) + a
  state[1] = (state[1] ?? 0) + b
  state[2] = (state[2] ?? 0) + c
  state[3] = (state[3] ?? 0) + d
}
