// A program's use of the generated files.

import { CallError, acceptedIn } from 'fc-protocol/runtime'
import type { Platform, ServerPlatform } from 'fc-protocol/runtime'
import { Client, Streams } from './client.ts'
import * as commands from './commands.ts'
import * as messages from './messages.ts'
import * as reports from './reports.ts'
import { ExampleRobot, Half, Reporter, serve } from './robot.ts'
import * as schemas from './schemas.ts'
import * as streams from './streams.ts'

export async function app(platform: Platform): Promise<void> {
  const client = await Client.connect(platform, { host: 'robot.local' })
  const { name } = await client.getName({}, { timeout: 1000 })
  console.log(name, client.state.is)
  try {
    const drive = await client.startDrive({ target: 'A' }).follow()
    console.log(drive.answer.drive)
    for await (const next of drive) if (next.is === 'ended') console.log(next.report.state)
  } catch (error) {
    if (!(error instanceof CallError)) throw error
    const which: 'NoSuchTarget' | 'Blocked' | null = error.declared(commands.startDrive)
    console.log(which)
  }
  for await (const report of client.reports()) {
    if (report.case === 'DriveProgress') console.log(report.value.drive)
    else console.log(report.code, report.value)
  }
  for await (const { state } of client.reports(reports.driveProgress))
    console.log(state === messages.DriveState.Arrived)
  for await (const { content } of client.data().subscribe(streams.scans)) console.log(content.ranges.length)
  await client.data().sendStream(streams.pictures, 7, new Uint8Array())
  await new Streams(client.data()).sendPictures(7, new Uint8Array())
  console.log(acceptedIn(commands.startDrive, schemas.DriveState, messages.DriveState.Idle))
}

export async function robot(platform: ServerPlatform): Promise<void> {
  const server = await serve(platform, new ExampleRobot({ pretendMotion: true }))
  await new Reporter(server).driveProgress({ drive: 1, state: messages.DriveState.Driving })
  await serve(platform, new Half())
}
