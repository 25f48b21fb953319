// Bytes and their spellings.

/** Upper-case hex with a space between bytes. */
export function hex(bytes: Uint8Array): string {
  return Array.from(bytes, hexByte).join(' ')
}

/** Two upper-case hex digits. */
export function hexByte(byte: number): string {
  return byte.toString(16).padStart(2, '0').toUpperCase()
}

/**
 * Bytes of a pasted dump: hex digits with any separators, `0x` prefixes, C arrays, `\x` escapes, and
 * dumps of `xxd`, `hexdump -C`, Wireshark and this site, with an offset in front and text behind.
 * `null` if a digit is left over or something is not hex.
 */
export function parseHex(text: string): Uint8Array | null {
  const prefixed = text.match(/(?:0x|\\x)[0-9a-fA-F]{1,2}(?![0-9a-fA-F])/gi)
  if (prefixed) return Uint8Array.from(prefixed, (token) => Number.parseInt(token.slice(2), 16))
  const lines = text.split('\n')
  const first = lines.find((line) => line.trim() !== '') ?? ''
  // Only a dump begins with an offset of zero: no frame has a head of zeros.
  const digits = (/^\s*0{4,8}:?\s/.test(first) ? lines.map(dumped) : lines).join('').replace(/[\s,;:{}()\[\]"'-]+/g, '')
  if (digits.length % 2 !== 0 || /[^0-9a-fA-F]/.test(digits)) return null
  const bytes = new Uint8Array(digits.length / 2)
  for (let at = 0; at < bytes.length; at++) bytes[at] = Number.parseInt(digits.slice(at * 2, at * 2 + 2), 16)
  return bytes
}

/** The digits of one line of a dump, without its offset and the text behind. */
function dumped(line: string): string {
  const body = line.replace(/^\s*[0-9a-fA-F]{4,8}:?/, '')
  let digits = ''
  for (const [, gap, token] of body.matchAll(/(\s+)(\S+)/g)) {
    const behind = digits !== '' && gap.length > 2
    if (behind || digits.length >= 32 || !/^(?:[0-9a-fA-F]{2})+$/.test(token)) break
    digits += token
  }
  return digits
}

/** A C array of the bytes, twelve to a line. */
export function cArray(bytes: Uint8Array, name: string): string {
  const lines: string[] = []
  for (let at = 0; at < bytes.length; at += 12) {
    lines.push('  ' + Array.from(bytes.subarray(at, at + 12), (byte) => `0x${hexByte(byte)}`).join(', '))
  }
  return `static const unsigned char ${name}[${bytes.length}] = {\n${lines.join(',\n')}\n};`
}

/** A shell line that sends the bytes with `nc` and shows the answer. */
export function ncLine(bytes: Uint8Array, host: string, port: number): string {
  // Octal escapes: the only spelling that every POSIX printf knows.
  const escaped = Array.from(bytes, (byte) => `\\${byte.toString(8).padStart(3, '0')}`).join('')
  return `printf '${escaped}' | nc -w 3 ${host} ${port} | xxd`
}

/** The unsigned integer in these bytes. */
export function readUint(bytes: Uint8Array, byteOrder: 'big' | 'little'): number {
  const ordered = byteOrder === 'big' ? bytes : Uint8Array.from(bytes).reverse()
  return ordered.reduce((value, byte) => value * 256 + byte, 0)
}

/** Writes an unsigned integer over all of `target`. */
export function writeUint(target: Uint8Array, value: number, byteOrder: 'big' | 'little'): void {
  for (let at = 0; at < target.length; at++) {
    const index = byteOrder === 'big' ? target.length - 1 - at : at
    target[index] = value % 256
    value = Math.floor(value / 256)
  }
}
