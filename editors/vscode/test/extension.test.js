// The extension in an editor that is not there: what it starts, and what it registers.

'use strict'

const assert = require('node:assert/strict')
const Module = require('node:module')
const { test } = require('node:test')
const manifest = require('../package.json')

/** Loads the extension with an editor of these settings; what it did there. */
function load(settings) {
  const did = { clients: [], commands: {}, executed: [] }
  class LanguageClient {
    constructor(id, name, server, options) {
      Object.assign(this, { id, server, options, running: false })
      this.protocol2CodeConverter = { asLocation: (it) => ['location', it], asPosition: (it) => ['position', it] }
      did.clients.push(this)
    }
    async start() {
      this.running = true
    }
    async dispose() {
      this.running = false
    }
  }
  const modules = {
    vscode: {
      env: { language: 'zh-cn' },
      Uri: { parse: (text) => ['uri', text] },
      commands: {
        registerCommand: (name, run) => (did.commands[name] = run),
        executeCommand: (...args) => did.executed.push(args),
      },
      workspace: {
        getConfiguration: () => ({ get: (key) => settings[key] }),
        onDidChangeConfiguration: (told) => (did.configure = told),
      },
    },
    'vscode-languageclient/node': { LanguageClient },
  }
  const real = Module._load
  Module._load = (name, ...rest) => modules[name] ?? real(name, ...rest)
  try {
    const path = require.resolve('../extension.js')
    delete require.cache[path]
    return { did, extension: require(path) }
  } finally {
    Module._load = real
  }
}

test('the server is started as the settings say', async () => {
  const defaults = Object.fromEntries(
    Object.entries(manifest.contributes.configuration.properties).map(([key, it]) => [key.replace('fc.', ''), it.default]),
  )
  for (const [settings, command, lang] of [
    [defaults, 'fcproto', 'zh-cn'],
    [{ path: '/opt/fcproto', lang: 'en' }, '/opt/fcproto', 'en'],
  ]) {
    const { did, extension } = load(settings)
    await extension.activate({ subscriptions: [] })
    const [client] = did.clients
    assert.ok(client.running)
    assert.deepEqual(client.server, { command, args: ['lsp'] })
    assert.deepEqual(client.options.initializationOptions, { showReferences: true, lang })
    await extension.deactivate()
    assert.ok(!client.running)
  }
})

test('every command of the manifest is there, and a change of the settings starts another server', async () => {
  const { did, extension } = load({ path: 'fcproto', lang: 'auto' })
  await extension.activate({ subscriptions: [] })
  for (const { command } of manifest.contributes.commands) assert.ok(did.commands[command], command)
  await did.configure({ affectsConfiguration: (name) => name === 'other' })
  assert.equal(did.clients.length, 1)
  await did.configure({ affectsConfiguration: (name) => name === 'fc' })
  assert.deepEqual(did.clients.map((client) => client.running), [false, true])
})

test('a lens shows its references', async () => {
  const { did, extension } = load({ path: 'fcproto', lang: 'auto' })
  await extension.activate({ subscriptions: [] })
  did.commands['fc.showReferences']('file:///a.yaml', { line: 1 }, [{ uri: 'file:///b.yaml' }])
  assert.deepEqual(did.executed, [
    [
      'editor.action.showReferences',
      ['uri', 'file:///a.yaml'],
      ['position', { line: 1 }],
      [['location', { uri: 'file:///b.yaml' }]],
    ],
  ])
})
