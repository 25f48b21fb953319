// Looks up parts of a protocol that belong together.

import type { HeaderField, HeaderRole, Kind, Operation, Protocol } from './protocol.ts'

/** Returns the header field with a role. Throws if there is none; a checked spec has each. */
export function fieldOf(protocol: Protocol, role: HeaderRole): HeaderField {
  const field = protocol.header.find((candidate) => candidate.role === role)
  if (!field) throw new Error(`the protocol has no header field with role ${role}`)
  return field
}

/**
 * Returns the operation with a code. A stream may share the code of the command that starts it; the frame's kind
 * distinguishes the two. Without a kind it is the command.
 */
export function operationOf(protocol: Protocol, code: number | null, kind: Kind | null = null): Operation | null {
  const all = protocol.operations.filter((operation) => operation.code !== null && operation.code === code)
  const isStream = kind?.role === 'stream'
  return all.find((operation) => (operation.kind === 'stream') === isStream) ?? all[0] ?? null
}

/** Returns the kind of frame for an operation. */
export function kindOf(protocol: Protocol, operation: Operation | null): Kind | null {
  return protocol.kinds.find(({ role }) => role === operation?.kind) ?? null
}
