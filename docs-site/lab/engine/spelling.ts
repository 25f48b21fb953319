// Bytes in the forms of other programs.

import { hexByte } from '../fc'

/** Returns a C array of the bytes, twelve to a line. */
export function cArray(bytes: Uint8Array, name: string): string {
  const lines: string[] = []
  for (let at = 0; at < bytes.length; at += 12) {
    lines.push('  ' + Array.from(bytes.subarray(at, at + 12), (byte) => `0x${hexByte(byte)}`).join(', '))
  }
  return `static const unsigned char ${name}[${bytes.length}] = {\n${lines.join(',\n')}\n};`
}

/** Returns a shell line that sends the bytes with `nc` and shows the response. */
export function ncLine(bytes: Uint8Array, host: string, port: number): string {
  // Octal escapes: the only spelling that every POSIX printf knows.
  const escaped = Array.from(bytes, (byte) => `\\${byte.toString(8).padStart(3, '0')}`).join('')
  return `printf '${escaped}' | nc -w 3 ${host} ${port} | xxd`
}
