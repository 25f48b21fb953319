// The form of the generated groups/GROUP/commands.ts.

import type { AnyCommand, Command, FollowedCommand } from 'fc-protocol/runtime'
import type * as messages from './messages.ts'
import * as reports from './reports.ts'
import * as schemas from './schemas.ts'

/** Asks for the name. */
export const getName: Command<messages.GetNameRequest, messages.GetNameResponse> = {
  is: 'command',
  name: 'get_name',
  code: 100,
  title: { zh: '获取名称', en: 'Get the name' },
  since: '2023-05',
  docs: 'reference/commands/get_name.md',
  spec: 'spec/commands/drive.yaml',
  effect: 'read',
  request: schemas.GetNameRequest,
  response: schemas.GetNameResponse,
  requestExample: () => ({}),
  responseExample: () => ({ name: 'r1' }),
  errors: {},
}

/** Drives somewhere. The reports of its drive can be followed. */
export const startDrive: FollowedCommand<
  messages.StartDriveRequest,
  messages.StartDriveResponse,
  messages.DriveProgress,
  'NoSuchTarget' | 'Blocked'
> = {
  is: 'command',
  name: 'start_drive',
  code: 200,
  title: { zh: '开始行驶', en: 'Start driving' },
  docs: 'reference/commands/start_drive.md',
  spec: 'spec/commands/drive.yaml',
  effect: 'motion',
  request: schemas.StartDriveRequest,
  response: schemas.StartDriveResponse,
  requestExample: () => ({ target: 'A' }),
  responseExample: () => ({ drive: 1 }),
  errors: { NoSuchTarget: { code: 10, text: 'no such target' }, Blocked: { code: 11, text: 'blocked' } },
  preconditions: { states: [{ of: schemas.DriveState, values: [0, 2] }], after: ['get_name'] },
  setsOff: {
    report: reports.driveProgress,
    tied: [{ call: (_request, response) => response.drive, report: (report) => report.drive }],
  },
}

/** The commands of the group, by the names of their methods. */
export default { getName, startDrive } as Readonly<Record<string, AnyCommand>>
