// A message of an operation to its frame.

import { encodeFrame } from './frame'
import { compact } from './json'
import type { Kind, Operation, Protocol } from './protocol'

/** The kind of frame that carries an operation. */
export function kindOf(protocol: Protocol, operation: Operation | null): Kind | null {
  return protocol.kinds.find(({ role }) => role === operation?.kind) ?? null
}

/** The frame of a message; `null` for an operation without a code. What is not JSON is sent as it is. */
export function messageFrame(
  protocol: Protocol,
  operation: Operation,
  { side, id, gzip }: { side: 'request' | 'response'; id: number; gzip: boolean },
  json: string,
): Uint8Array | null {
  const kind = kindOf(protocol, operation)
  if (operation.code === null || !kind) return null
  return encodeFrame(protocol, {
    response: side === 'response',
    kind: kind.value,
    code: operation.code,
    id,
    gzip,
    // Indentation is for people.
    data: new TextEncoder().encode(compact(json, protocol.limits.jsonDepth)),
  })
}
