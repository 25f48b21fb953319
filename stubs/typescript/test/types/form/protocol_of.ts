// What is emitted as operations.ts: the protocol with all of its operations.

import type { ProtocolOf, ServiceOf } from 'fc-protocol/runtime'
import * as commands from './commands.ts'
import * as reports from './reports.ts'
import * as streams from './streams.ts'
import { wire } from './wire.ts'

/** The protocol: its numbers and its operations. */
export const toy: ProtocolOf = {
  wire,
  commands: [commands.getName, commands.startDrive],
  reports: [reports.driveProgress],
  streams: [streams.scans, streams.pictures],
}

/** Which command each method of a robot handles. */
export const service: ServiceOf = {
  methods: { getName: commands.getName, startDrive: commands.startDrive },
  ranges: [{ first: 500, last: 599, method: 'passThrough' }],
  unknown: 'unknown',
}
