// What belongs to what in a protocol.

import type { HeaderField, HeaderRole, Kind, Operation, Protocol } from './protocol.ts'

/** The header field with a role. Throws for a protocol that has none, which no spec without faults makes. */
export function fieldOf(protocol: Protocol, role: HeaderRole): HeaderField {
  const field = protocol.header.find((candidate) => candidate.role === role)
  if (!field) throw new Error(`the protocol has no header field with role ${role}`)
  return field
}

/** The operation that a code belongs to. Codes are given out once, whatever the kind. */
export function operationOf(protocol: Protocol, code: number | null): Operation | null {
  return protocol.operations.find((operation) => operation.code !== null && operation.code === code) ?? null
}

/** The kind of frame that carries an operation. */
export function kindOf(protocol: Protocol, operation: Operation | null): Kind | null {
  return protocol.kinds.find(({ role }) => role === operation?.kind) ?? null
}
