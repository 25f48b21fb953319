// The samples of the documentation call every command, push every report and receive it.

import { test } from 'node:test'
import { Fc } from 'fc-protocol'
import { nodePlatform } from 'fc-protocol/node'
import { run } from '../dist/generated/samples.js'
import { assertSampled } from './support.mjs'

test('every sample runs', async (context) => {
  const { commands, reports, streams } = Fc
  const own = streams.filter(({ from }) => from === 'robot')
  await assertSampled(context, () => run(nodePlatform, nodePlatform), commands.length, reports.length, own.length)
})
