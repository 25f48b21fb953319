// What a frame needs beside arithmetic. It is handed in, since each platform has its own: `node.ts` has those
// of Node.js, and in a browser any library of one's choice does.

import type { ErrorName } from './errors.ts'
import type { Protocol } from './protocol.ts'

/** MD5 and gzip. */
export interface Algorithms {
  /** The sixteen bytes of the MD5 digest. */
  md5(data: Uint8Array): Uint8Array
  /** Packs into one gzip member. */
  gzip(data: Uint8Array): Uint8Array
  /**
   * Unpacks one gzip member, and gives up as soon as more than `limit` bytes come out. Bytes behind the member, such as
   * zeros or a second member, are `bad_gzip`. It need not check the checksum and the length at the member's end, which the decoder does.
   */
  gunzip(member: Uint8Array, limit: number): Uint8Array | GunzipFault
}

/** Why a gzip member was not unpacked. */
export type GunzipFault = Extract<ErrorName, 'bad_gzip' | 'inflated_too_long'>

/** A protocol with what its frames need. */
export interface Codec {
  /** The protocol. */
  protocol: Protocol
  /** MD5 and gzip. */
  algorithms: Algorithms
}
