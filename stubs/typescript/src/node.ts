// MD5 and gzip of Node.js.

import { createHash } from 'node:crypto'
import { gunzipSync, gzipSync } from 'node:zlib'
import type { Algorithms } from './algorithms.ts'

/** Those of Node.js itself. */
export const nodeAlgorithms: Algorithms = {
  md5: (data) => createHash('md5').update(data).digest(),
  gzip: (data) => gzipSync(data),
  gunzip(member, limit) {
    try {
      return gunzipSync(member, { maxOutputLength: Math.max(1, limit) })
    } catch (problem) {
      return (problem as { code?: unknown }).code === 'ERR_BUFFER_TOO_LARGE' ? 'inflated_too_long' : 'bad_gzip'
    }
  },
}
