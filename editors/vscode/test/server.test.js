// The server and the library by which the editor speaks: the same messages on both sides. The command is built before:
// `cargo build -p fc-cli`, or another one in the variable FC.

'use strict'

const assert = require('node:assert/strict')
const { spawn } = require('node:child_process')
const { cpSync, mkdtempSync, readFileSync, rmSync } = require('node:fs')
const { tmpdir } = require('node:os')
const { join, resolve } = require('node:path')
const { test } = require('node:test')
const { pathToFileURL } = require('node:url')
const lsp = require('vscode-languageserver-protocol/node')

const root = resolve(__dirname, '../../..')
const fcproto = process.env.FC ?? join(root, 'target/debug/fcproto')

test('faults, a fix and an explanation reach the client', async (t) => {
  const project = mkdtempSync(join(tmpdir(), 'fc-editor-'))
  t.after(() => rmSync(project, { recursive: true }))
  cpSync(join(root, 'fc-codegen/tests/docs/spec'), join(project, 'spec'), { recursive: true })
  const server = spawn(fcproto, ['lsp'], { stdio: ['pipe', 'pipe', 'inherit'] })
  const ended = new Promise((done) => server.on('close', done))
  const client = lsp.createProtocolConnection(server.stdout, server.stdin)
  const told = []
  const waiting = []
  client.onNotification(lsp.PublishDiagnosticsNotification.type, (params) => {
    const waits = waiting.findIndex(({ version, uri }) => params.version === version && params.uri === uri)
    if (waits >= 0) waiting.splice(waits, 1)[0].done(params.diagnostics)
    else told.push(params)
  })
  const faults = (uri, version) => {
    const known = told.find((params) => params.version === version && params.uri === uri)
    return known ? known.diagnostics : new Promise((done) => waiting.push({ uri, version, done }))
  }
  client.listen()

  const rootUri = pathToFileURL(project).href
  const { capabilities } = await client.sendRequest(lsp.InitializeRequest.type, {
    processId: null,
    rootUri,
    capabilities: {},
  })
  assert.equal(capabilities.positionEncoding, 'utf-16')
  await client.sendNotification(lsp.InitializedNotification.type, {})

  const path = join(project, 'spec/types.yaml')
  const uri = pathToFileURL(path).href
  const text = readFileSync(path, 'utf8').replace('unit: mm', 'unti: mm')
  const textDocument = { uri, languageId: 'yaml', version: 1, text }
  await client.sendNotification(lsp.DidOpenTextDocumentNotification.type, { textDocument })
  const [fault, ...others] = await faults(uri, 1)
  assert.deepEqual(others, [])
  const line = text.split('\n')[fault.range.start.line]
  assert.equal(line.slice(fault.range.start.character, fault.range.end.character), 'unti')

  const actions = await client.sendRequest(lsp.CodeActionRequest.type, {
    textDocument: { uri },
    range: fault.range,
    context: { diagnostics: [fault] },
  })
  const [{ edits }] = actions[0].edit.documentChanges
  assert.deepEqual(edits, [{ range: fault.range, newText: 'unit' }])
  const contentChanges = [{ range: edits[0].range, text: edits[0].newText }]
  await client.sendNotification(lsp.DidChangeTextDocumentNotification.type, {
    textDocument: { uri, version: 2 },
    contentChanges,
  })
  assert.deepEqual(await faults(uri, 2), [])
  const hover = await client.sendRequest(lsp.HoverRequest.type, { textDocument: { uri }, position: fault.range.start })
  assert.match(hover.contents.value, /^`unit`/)

  await client.sendRequest(lsp.ShutdownRequest.type)
  await client.sendNotification(lsp.ExitNotification.type)
  assert.equal(await ended, 0)
})
