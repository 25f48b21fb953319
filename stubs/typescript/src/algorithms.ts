// Algorithms that a frame needs and that the caller supplies, since each platform has its own. `node.ts` has those of
// Node.js. In a browser any library works.

import type { ErrorName } from './errors.ts'
import type { Protocol } from './protocol.ts'

/** MD5 and gzip. */
export interface Algorithms {
  /** The sixteen bytes of the MD5 digest. */
  md5(data: Uint8Array): Uint8Array
  /** Packs into one gzip member. */
  gzip(data: Uint8Array): Uint8Array
  /**
   * Unpacks one gzip member, and gives up once the output exceeds `limit` bytes. Bytes after the member, such as zeros
   * or a second member, are `bad_gzip`. It need not check the checksum and the length at the member's end: the decoder
   * does.
   */
  gunzip(member: Uint8Array, limit: number): Uint8Array | GunzipFault
}

/** Errors of unpacking a gzip member. */
export type GunzipFault = Extract<ErrorName, 'bad_gzip' | 'inflated_too_long'>

/** A protocol with the algorithms that its frames need. */
export interface Codec {
  /** The protocol. */
  protocol: Protocol
  /** MD5 and gzip. */
  algorithms: Algorithms
}
