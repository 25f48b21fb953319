// The form of the generated groups/GROUP/reports.ts.

import type { AnyReportOf, Report } from 'fc-protocol/runtime'
import type * as messages from './messages.ts'
import * as schemas from './schemas.ts'

/** Progress of a drive. */
export const driveProgress: Report<messages.DriveProgress, 'DriveProgress'> = {
  is: 'report',
  name: 'drive_progress',
  case: 'DriveProgress',
  code: 300,
  title: { zh: '行驶进度', en: 'How far a drive has come' },
  docs: 'reference/reports/drive_progress.md',
  spec: 'spec/commands/drive.yaml',
  body: schemas.DriveProgress,
  acknowledgement: schemas.DriveProgressAck,
  example: () => ({ drive: 1, state: 1 }),
  ack: { timeout: 2000, retries: 3 },
  cadence: { is: 'on_change', field: 'state' },
  state: { schema: schemas.DriveState, of: (report) => report.state },
}

/** The reports of the group, by the names of their methods. */
export default { driveProgress } as Readonly<Record<string, AnyReportOf>>
