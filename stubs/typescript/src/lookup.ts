// What belongs to what in a protocol.

import type { HeaderField, HeaderRole, Kind, Operation, Protocol } from './protocol.ts'

/** The header field with a role. Throws for a protocol that has none, which no spec without faults makes. */
export function fieldOf(protocol: Protocol, role: HeaderRole): HeaderField {
  const field = protocol.header.find((candidate) => candidate.role === role)
  if (!field) throw new Error(`the protocol has no header field with role ${role}`)
  return field
}

/**
 * The operation that a code belongs to. A stream may have the code of the command that starts it; which of the two is
 * meant, the kind of the frame says. Without one it is the command.
 */
export function operationOf(protocol: Protocol, code: number | null, kind: Kind | null = null): Operation | null {
  const all = protocol.operations.filter((operation) => operation.code !== null && operation.code === code)
  const isStream = kind?.role === 'stream'
  return all.find((operation) => (operation.kind === 'stream') === isStream) ?? all[0] ?? null
}

/** The kind of frame that carries an operation. */
export function kindOf(protocol: Protocol, operation: Operation | null): Kind | null {
  return protocol.kinds.find(({ role }) => role === operation?.kind) ?? null
}
