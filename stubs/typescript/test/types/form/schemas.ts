// The form of the generated groups/GROUP/schemas.ts: the runtime's schema of each type, under the type's name.

import type { Enum, Struct } from 'fc-protocol/runtime'
import * as messages from './messages.ts'

export const DriveState: Enum<messages.DriveState> = {
  is: 'enum',
  name: 'DriveState',
  repr: 'u8',
  values: messages.DriveState,
  process: {
    order: 'complete',
    next: [
      [0, [1]],
      [1, [2]],
    ],
    final: [2],
    error: [3],
  },
}

export const GetNameRequest: Struct<messages.GetNameRequest> = { is: 'struct', name: 'GetNameRequest', fields: {} }

export const GetNameResponse: Struct<messages.GetNameResponse> = {
  is: 'struct',
  name: 'GetNameResponse',
  fields: { name: { key: 'name', type: 'string' } },
}

export const StartDriveRequest: Struct<messages.StartDriveRequest> = {
  is: 'struct',
  name: 'StartDriveRequest',
  fields: { target: { key: 'target', type: 'string', length: [1, 20] } },
}

export const StartDriveResponse: Struct<messages.StartDriveResponse> = {
  is: 'struct',
  name: 'StartDriveResponse',
  fields: { drive: { key: 'drive', type: 'i32' } },
}

export const DriveProgress: Struct<messages.DriveProgress> = {
  is: 'struct',
  name: 'DriveProgress',
  fields: { drive: { key: 'drive', type: 'i32' }, state: { key: 'state', type: () => DriveState, optional: true } },
}

export const DriveProgressAck: Struct<messages.DriveProgressAck> = {
  is: 'struct',
  name: 'DriveProgressAck',
  fields: {},
}

export const Scan: Struct<messages.Scan> = {
  is: 'struct',
  name: 'Scan',
  fields: { ranges: { key: 'ranges', type: { list: 'f64' } } },
}
