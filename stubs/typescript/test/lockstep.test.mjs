// Effects of a changed spec on a program: it gets the new operations, and the compiler names the removed ones.

import assert from 'node:assert/strict'
import { writeFileSync } from 'node:fs'
import path from 'node:path'
import { test } from 'node:test'
import { compile, generate, load, packageOf, replaced, unlessGenerated } from './packages.mjs'

/** A program that uses the meter. */
const PROGRAM = `
import { Client, ExampleRobot, PartialRobot, commands } from './generated/index.ts'
import type { Context, ReadPowerResponse, Robot, SwitchMoved } from './generated/index.ts'

export async function watts(client: Client): Promise<number> {
  const { watts, closed } = await client.readPower()
  return closed ? watts : 0
}

export const cause = ({ cause }: SwitchMoved): string | undefined => cause

const examples = new ExampleRobot()

export const robot: Robot = {
  readPower: (): ReadPowerResponse => ({ watts: 1.5, phases: [], closed: true }),
  setTariff: () => commands.setTariff.responseExample(),
  closeSwitch: (request, context: Context) => examples.closeSwitch(request, context),
  watchLoad: () => commands.watchLoad.responseExample(),
}

export class Part extends PartialRobot {
  override closeSwitch: Robot['closeSwitch'] = (request, context) => examples.closeSwitch(request, context)

  override readPower(): ReadPowerResponse {
    return commands.readPower.responseExample()
  }

  helper(): void {}
}
`

const TELL_TIME = `
  tell_time:
    code: 0x1005
    zh: 报时
    en: Tell the time
    effect: read
    source: { sections: [] }
    response: { now: { type: timestamp_ms, example: 0, zh: 时间, en: Time } }

reports:
`

for (const [what, change, said] of [
  ['nothing', (text) => text, []],
  ['a field is renamed', replaced('name: watts', 'name: power_now'), ["Property 'watts' does not exist"]],
  ['a field is removed', replaced('      closed: {', '      shut: {'), ["Property 'closed' does not exist"]],
  [
    'a type is changed',
    replaced('type: f64, name: watts, unit: W, example: 1.5', 'type: string, name: watts, example: a'),
    ['string'],
  ],
  ['a field may be absent', replaced('type: f64, name: watts', 'type: "f64?", name: watts'), ["'undefined'"]],
  [
    'a command is renamed',
    replaced('read_power', 'read_energy'),
    ["Property 'readPower' does not exist", 'ReadPowerResponse'],
  ],
  ['a command is added', replaced('\nreports:\n', TELL_TIME), ["Property 'tellTime' is missing"]],
]) {
  test(`a program when ${what}`, { skip: unlessGenerated }, () => {
    const folder = packageOf('lockstep', 'meter', change)
    generate(folder)
    writeFileSync(path.join(folder, 'program.ts'), PROGRAM)
    const found = compile(folder)
    if (said.length === 0) assert.equal(found, '')
    else assert.match(found, /^program\.ts\(/)
    for (const part of said) assert.ok(found.includes(part), `${part}\n${found}`)
    assert.ok(!/^(?:generated|src)\//m.test(found), found)
  })
}

test('misspelt_handler_is_refused_by_the_compiler', { skip: unlessGenerated }, () => {
  const folder = packageOf('misspelt', 'meter', (text) => text)
  generate(folder)
  writeFileSync(path.join(folder, 'program.ts'), PROGRAM.replace('override readPower()', 'override readPwoer()'))
  assert.match(compile(folder), /^program\.ts\(.*Did you mean 'readPower'\?\n$/)
})

test('a command that is added is there', { skip: unlessGenerated }, () => {
  const folder = packageOf('added', 'meter', replaced('\nreports:\n', TELL_TIME))
  generate(folder)
  const program = `
import { Client, commands } from './generated/index.ts'
export const now = async (client: Client): Promise<bigint> => (await client.tellTime()).now
export const code: number | null = commands.tellTime.code
`
  writeFileSync(path.join(folder, 'program.ts'), program)
  assert.equal(compile(folder), '')
})

test('ids_are_sent_as_their_values_and_do_not_mix', { skip: unlessGenerated }, async () => {
  const folder = packageOf('ids', 'meter', (text) => text)
  writeFileSync(path.join(folder, 'fc.yaml'), 'targets: { typescript: { out: generated, newtypes: true } }\n')
  generate(folder)
  const program = (tariff) => `
import { Band, OperatorId, TariffId, defaults, schemas, toJson } from './generated/index.ts'
import type { SetTariffRequest } from './generated/index.ts'
export const operator: OperatorId = OperatorId('anna')
export const usual: TariffId = defaults.SetTariffRequest.tariff
export const request: SetTariffRequest = { band: Band.Day, price: 3, note: 'x', tariff: ${tariff} }
export const text: string = toJson(schemas.SetTariffRequest, request)
`
  for (const [tariff, said] of [
    ['3', "'number' is not assignable to type 'TariffId'"],
    ['operator', "'OperatorId' is not assignable to type 'TariffId'"],
    ['TariffId(3)', ''],
  ]) {
    writeFileSync(path.join(folder, 'program.ts'), program(tariff))
    const found = compile(folder)
    if (said === '') assert.equal(found, '')
    else assert.ok(found.includes(said), found)
  }
  const { text, usual } = await load(folder, 'program.js')
  assert.equal(JSON.parse(text).tariff, '3')
  assert.equal(usual, 7)
})
