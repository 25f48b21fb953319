// A message of an operation to its frame.

import type { Codec } from './algorithms.ts'
import { encodeFrame } from './frame.ts'
import { compact } from './json.ts'
import { kindOf } from './lookup.ts'
import type { Operation, Side } from './protocol.ts'

/** What a message's frame says beside its body. */
export interface MessageParts {
  /** Which message of the operation. */
  side: Side
  /** Message id. */
  id: number
  /** Whether the body is compressed. */
  gzip: boolean
}

/** The frame of a message; `null` for an operation without a code. What is not JSON is sent as it is. */
export function messageFrame(
  codec: Codec,
  operation: Operation,
  { side, id, gzip }: MessageParts,
  json: string,
): Uint8Array | null {
  const kind = kindOf(codec.protocol, operation)
  if (operation.code === null || !kind) return null
  return encodeFrame(codec, {
    response: side === 'response',
    kind: kind.value,
    code: operation.code,
    id,
    gzip,
    // Indentation is for people.
    data: new TextEncoder().encode(compact(json, codec.protocol.limits.jsonDepth)),
  })
}
