// The state of the frame lab as text, for the page's address or for the tab. It never goes to a server, since a
// browser does not send the part after `#`.

import { deflateSync, inflateSync } from 'fflate'

export interface LabState {
  /** The pasted text, unchanged. */
  paste: string
  operation: string
  side: 'request' | 'response'
  id: number
  gzip: boolean
  /** `null` while it is the spec's example. */
  json: string | null
}

/** Some programs that send links cut longer addresses. */
export const LINK_LIMIT = 4000

const MARK = 'lab='

/** Returns the part of an address after `#`, of any length. */
export function toHash(state: LabState): string {
  const { paste, operation, side, id, gzip, json } = state
  const packed = deflateSync(new TextEncoder().encode(JSON.stringify([paste, operation, side, id, gzip, json])))
  let binary = ''
  for (const byte of packed) binary += String.fromCharCode(byte)
  return MARK + btoa(binary).replace(/\+/g, '-').replace(/\//g, '_').replace(/=+$/, '')
}

/** The bytes of one frame in an address, as other pages link to the frame lab. */
const FRAME = /^hex=((?:[0-9a-f]{2})+)$/i

/** Returns the state in such a part, with or without its `#`; `null` if it has none. */
export function fromHash(hash: string): LabState | null {
  const text = hash.replace(/^#/, '')
  const frame = FRAME.exec(text)?.[1]
  if (frame) return { paste: frame.toUpperCase().replace(/..(?=.)/g, '$& '), operation: '', side: 'request', id: 1, gzip: false, json: null }
  if (!text.startsWith(MARK)) return null
  try {
    const binary = atob(text.slice(MARK.length).replace(/-/g, '+').replace(/_/g, '/'))
    const plain = inflateSync(Uint8Array.from(binary, (character) => character.charCodeAt(0)))
    const [paste, operation, side, id, gzip, json]: unknown[] = JSON.parse(new TextDecoder().decode(plain))
    const sound =
      typeof paste === 'string' && typeof operation === 'string' && (side === 'request' || side === 'response') &&
      typeof gzip === 'boolean' && (json === null || typeof json === 'string')
    // An emptied box has no number, and must not discard the pasted text.
    return sound ? { paste, operation, side, id: typeof id === 'number' ? id : 1, gzip, json } : null
  } catch {
    return null
  }
}
