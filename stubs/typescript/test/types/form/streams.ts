// The form of the generated groups/GROUP/streams.ts.

import type { AnyStream, Stream } from 'fc-protocol/runtime'
import type * as messages from './messages.ts'
import * as schemas from './schemas.ts'

/** Scans, as JSON. */
export const scans: Stream<messages.Scan> = {
  is: 'stream',
  name: 'scans',
  code: 400,
  title: { zh: '扫描', en: 'Scans' },
  docs: 'reference/streams/scans.md',
  spec: 'spec/commands/drive.yaml',
  from: 'robot',
  content: schemas.Scan,
  startedBy: 'start_drive',
}

/** Pictures, as raw bytes. */
export const pictures: Stream<Uint8Array> = {
  is: 'stream',
  name: 'pictures',
  code: 401,
  title: { zh: '图片', en: 'Pictures' },
  docs: 'reference/streams/pictures.md',
  spec: 'spec/commands/drive.yaml',
  from: 'app',
  content: null,
  mediaType: 'image/png',
}

/** The streams of the group, by the names in their methods. */
export default { Scans: scans, Pictures: pictures } as Readonly<Record<string, AnyStream>>
