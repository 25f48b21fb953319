// The form of the generated operations.ts: the protocol with all of its operations, group by group.

import type { AnyCommand, AnyReportOf, AnyStream, ProtocolOf, ServiceOf } from 'fc-protocol/runtime'
import driveCommands from './commands.ts'
import driveReports from './reports.ts'
import driveStreams from './streams.ts'
import { wire } from './wire.ts'

/** All commands, by the names of their methods. */
export const commands: Readonly<Record<string, AnyCommand>> = {
  ...driveCommands,
}

/** All reports, by the names of their methods. */
export const reports: Readonly<Record<string, AnyReportOf>> = {
  ...driveReports,
}

/** All streams, by the names in their methods. */
export const streams: Readonly<Record<string, AnyStream>> = {
  ...driveStreams,
}

/** The protocol: its numbers and its operations. */
export const toy: ProtocolOf = {
  wire,
  commands: Object.values(commands),
  reports: Object.values(reports),
  streams: Object.values(streams),
}

/** The command that each method of a robot handles. */
export const service: ServiceOf = {
  methods: commands,
  ranges: [{ first: 500, last: 599, method: 'passThrough' }],
  unknown: 'unknown',
}
