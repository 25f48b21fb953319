// Bytes and their spellings.

/** Upper-case hex with a space between bytes. */
export function hex(bytes: Uint8Array): string {
  return Array.from(bytes, hexByte).join(' ')
}

/** Two upper-case hex digits. */
export function hexByte(byte: number): string {
  return byte.toString(16).padStart(2, '0').toUpperCase()
}

/** Returns `0x` and at least `digits` upper-case hex digits. */
export function hexNumber(value: number, digits: number): string {
  return `0x${value.toString(16).toUpperCase().padStart(digits, '0')}`
}

/** Returns the unsigned integer in these bytes. */
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
