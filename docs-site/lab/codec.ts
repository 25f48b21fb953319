// The protocol with the package's MD5 and a gzip for browsers.

import { Gunzip, gzipSync } from 'fflate'
import { md5, protocol, type Codec, type GunzipFault } from './fc'

/** Unpacks one gzip member, giving up past `limit` bytes. */
function gunzip(member: Uint8Array, limit: number): Uint8Array | GunzipFault {
  const parts: Uint8Array[] = []
  let length = 0
  let ended = false
  const stream = new Gunzip((part, final) => {
    parts.push(part)
    length += part.length
    ended = final
    if (length > limit) throw limit
  })
  try {
    stream.push(member, true)
  } catch (problem) {
    return problem === limit ? 'inflated_too_long' : 'bad_gzip'
  }
  if (!ended) return 'bad_gzip'
  const plain = new Uint8Array(length)
  let at = 0
  for (const part of parts) {
    plain.set(part, at)
    at += part.length
  }
  return plain
}

/** The codec that the pages decode and encode frames with. */
export const codec: Codec = {
  protocol,
  algorithms: {
    md5,
    gzip: (data) => gzipSync(data, { mtime: 0 }),
    gunzip,
  },
}
