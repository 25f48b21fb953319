// Minimal protocols, parts for an audience, and names that the language reserves.

import assert from 'node:assert/strict'
import { cpSync, readFileSync, writeFileSync } from 'node:fs'
import path from 'node:path'
import { test } from 'node:test'
import { Connection } from 'fc-protocol/runtime'
import { compile, generate, load, packageOf, replaced, unlessGenerated } from './packages.mjs'
import { assertSampled, root } from './support.mjs'

const GROUP = 'group: { id: place, zh: 名, en: Place }\n'

for (const [what, commands] of [
  ['nothing', ''],
  [
    'a command without a code',
    'commands:\n  later: { code: unassigned, zh: 名, en: Later, effect: read, source: { sections: [] } }\n',
  ],
  ['one report', 'reports:\n  heard: { code: 0x0101, zh: 名, en: Heard, source: { sections: [] }, body: {} }\n'],
]) {
  test(`a protocol that has ${what}`, { skip: unlessGenerated }, () => {
    const folder = packageOf('bare', 'beacon', (text, file) =>
      file.endsWith('place.yaml')
        ? GROUP + commands
        : // A name that the runtime has as well.
          text.replace(/^entities:[^]*/m, '').replace(/^ {2}id: .*/m, '  id: server'),
    )
    generate(folder)
    assert.equal(compile(folder), '')
  })
}

test('each audience has a whole package', { skip: unlessGenerated }, () => {
  for (const [audience, has] of [
    ['resident_app', false],
    ['installer_app', true],
  ]) {
    const folder = packageOf('audience', 'meter', (text) => text)
    writeFileSync(path.join(folder, 'fc.yaml'), `targets: { typescript: { out: generated, audience: ${audience} } }\n`)
    generate(folder)
    assert.equal(compile(folder), '')
    const messages = readFileSync(path.join(folder, 'generated/groups/power/messages.ts'), 'utf8')
    assert.equal(messages.includes('closeSwitch('), has, audience)
  }
})

test('commands may have the names of connection members', { skip: unlessGenerated }, () => {
  // Spelled as in the spec: `inFlight` is `in_flight`.
  const members = Object.getOwnPropertyNames(Connection.prototype).filter((name) => name !== 'constructor')
  const words = [...members, 'connect', 'connectLazy', 'core', 'server', 'pretendMotion', 'passThrough']
  const names = words.map((word) => word.replaceAll(/[A-Z]/g, (letter) => `_${letter.toLowerCase()}`))
  const command = (name, index) =>
    `  "${name}": { code: 0x${(0x1100 + index).toString(16).toUpperCase()}, zh: 名称, en: Name, effect: motion, source: { sections: [] } }\n`
  const added = `\n${names.map(command).join('')}\nreports:\n`
  const folder = packageOf('members', 'meter', replaced('\nreports:\n', added))
  generate(folder)
  assert.equal(compile(folder), '')
})

test('names and texts that the language keeps for itself', { skip: unlessGenerated }, async (t) => {
  // The generator reports the one name that the language cannot have.
  const odd = packageOf('odd', 'odd', (text) => text)
  assert.throws(() => generate(odd), /`Error` already has a meaning in TypeScript/)
  const folder = packageOf('nasty', 'odd', (text) =>
    text
      .replaceAll(/^ {2}Error:/gm, '  Fault:')
      .replaceAll(/type: ("?)Error\b/g, 'type: $1Fault')
      // One millisecond is too short for a busy machine.
      .replaceAll(/timeout_ms: 1\b/g, 'timeout_ms: 1000'),
  )
  cpSync(path.join(root, 'test/generator/nasty.yaml'), path.join(folder, 'spec/commands/nasty.yaml'))
  generate(folder)
  assert.equal(compile(folder), '')

  const { Client, ExampleRobot, Reporter, commands, reports, serve, streams } = await load(folder, 'generated/index.js')
  const { nodePlatform } = await load(folder, 'src/node.js')
  assert.ok(['delete_', 'then_', 'state_', 'schemas_'].every((name) => name in commands))
  const address = '127.0.0.1'
  const server = await serve(nodePlatform, new ExampleRobot({ pretendMotion: true }), {
    address,
    commandPort: 0,
    dataPort: 0,
  })
  t.after(() => server.shutdown(0))
  const client = await Client.connect(nodePlatform, {
    host: address,
    commandPort: server.commandPort,
    dataPort: server.dataPort,
  })
  t.after(() => client.close())
  assert.equal(typeof client.then, 'undefined')
  for (const [method, command] of Object.entries(commands)) {
    assert.deepEqual(await client[method](command.requestExample()), command.responseExample(), method)
  }
  const arriving = client.reports()
  const reporter = new Reporter(server)
  for (const [method, report] of Object.entries(reports)) {
    const pushed = reporter[method](report.example())
    const { value } = await arriving.next()
    assert.equal(value.case, report.case)
    assert.deepEqual(value.value, report.example())
    assert.deepEqual(
      (await pushed).map(({ outcome }) => outcome),
      ['acknowledged'],
    )
  }

  const { run } = await load(folder, 'generated/samples.js')
  const counts = [commands, reports].map((all) => Object.keys(all).length)
  counts.push(Object.values(streams).filter(({ from }) => from === 'robot').length)
  await assertSampled(t, () => run(nodePlatform, nodePlatform), ...counts)
})
