// An app that tries out a robot. It calls every command with the spec's example, receives the robot's reports and the
// picture of a map, and prints each result.

import { CallError, Client, Fc, commands } from 'fc-protocol'
import type { AnyReport, DataConnection, Reports } from 'fc-protocol'
import { nodePlatform } from 'fc-protocol/node'
import { main, ports, table, within } from './support.ts'
import type { Args } from './support.ts'

const USAGE = `Calls every command of a robot and prints what came of it.

Usage: app [--host 127.0.0.1] [--command-port PORT] [--data-port PORT] [--gzip-from BYTES]
           [--lang zh|en]

Without ports, those of the spec. With --gzip-from, whatever has so many bytes is compressed.
Without --lang, the language of the environment.`

/** Time the app waits for reports and pictures, in milliseconds. */
const PATIENCE = 20_000

/** Words of the table. */
const WORDS = {
  zh: {
    head: ['功能码', '类型', '名称', '说明', '结果'],
    command: '指令',
    report: '主动上报',
    stream: '数据流',
    answered: '成功',
    received: '收到',
    picture: (bytes: number, id: number): string => `收到 ${bytes} 字节，msgId ${id}，MD5 一致`,
  },
  en: {
    head: ['Code', 'Kind', 'Name', 'Title', 'Outcome'],
    command: 'command',
    report: 'report',
    stream: 'stream',
    answered: 'answered',
    received: 'received',
    picture: (bytes: number, id: number): string => `received ${bytes} bytes, msgId ${id}, MD5 verified`,
  },
}

/** Results of the operations so far. */
class Tour {
  readonly lang: Args['lang']
  readonly words: (typeof WORDS)[Args['lang']]
  readonly rows: string[][]
  failed = 0

  constructor(lang: Args['lang']) {
    this.lang = lang
    this.words = WORDS[lang]
    this.rows = [this.words.head]
  }

  add(code: number, kind: string, outcome: string, isGood: boolean = true): void {
    const known = [...Fc.commands, ...Fc.reports].find((operation) => operation.code === code)
    if (!isGood) this.failed++
    this.rows.push([
      `0x${code.toString(16).toUpperCase().padStart(4, '0')}`,
      kind,
      known?.name ?? '',
      known?.title[this.lang] ?? '',
      outcome,
    ])
  }
}

await main(USAGE, async (args) => {
  // Closed at the end and after an error: an open connection keeps the program running.
  await using client = await Client.connect(nodePlatform, { host: args.host, gzip: args.gzip, ...ports(args) })
  const reports = client.reports()
  // #region data
  const data = client.data()
  await data.connected()
  // #endregion data

  const tour = new Tour(args.lang)
  await callAll(client, tour)
  await receiveAll(reports, tour)
  await receivePicture(data, tour)
  console.log(table(tour.rows))
  if (tour.failed > 0) throw new Error(`${tour.failed} operations failed`)
})

/** Calls every command with the spec's example. */
async function callAll(client: Client, tour: Tour): Promise<void> {
  for (const command of Fc.commands) {
    try {
      await client.callAny(command, command.requestExample())
      tour.add(command.code ?? 0, tour.words.command, tour.words.answered)
    } catch (problem) {
      if (!(problem instanceof CallError)) throw problem
      tour.add(command.code ?? 0, tour.words.command, problem.message, false)
    }
  }
}

/** Waits until every report has come once. */
async function receiveAll(reports: Reports<AnyReport>, tour: Tour): Promise<void> {
  const missing = new Set(Fc.reports.map(({ code }) => code))
  while (missing.size > 0) {
    const next = await within(PATIENCE, `no report for a while; missing: ${[...missing].join(', ')}`, reports.next())
    if (next.done) throw new Error('the robot has left')
    if (missing.delete(next.value.code)) tour.add(next.value.code, tour.words.report, tour.words.received)
  }
}

/** Waits for the picture requested by the call for a map image. Its digest has already been verified. */
async function receivePicture(data: DataConnection, tour: Tour): Promise<void> {
  const frame = await within(PATIENCE, 'no picture came', data.recv())
  if (frame.code === commands.getMapImage.code)
    tour.add(frame.code, tour.words.stream, tour.words.picture(frame.data.length, frame.id))
  else tour.add(frame.code, tour.words.stream, 'unexpected picture', false)
}
