// Starts `fcproto lsp` and lets the editor talk to it.

'use strict'

const vscode = require('vscode')
const { LanguageClient } = require('vscode-languageclient/node')

let client

/** Called by the editor when a spec is in the workspace. */
async function activate(context) {
  const { subscriptions } = context
  subscriptions.push(
    vscode.commands.registerCommand('fc.restart', restart),
    // The references of a lens. The server sends positions of the protocol, and the editor needs its own objects.
    vscode.commands.registerCommand('fc.showReferences', (uri, position, places) => {
      const { protocol2CodeConverter: code } = client
      const found = places.map((place) => code.asLocation(place))
      return vscode.commands.executeCommand(
        'editor.action.showReferences',
        vscode.Uri.parse(uri),
        code.asPosition(position),
        found,
      )
    }),
    vscode.workspace.onDidChangeConfiguration((event) => (event.affectsConfiguration('fc') ? restart() : undefined)),
  )
  await start()
}

async function start() {
  const settings = vscode.workspace.getConfiguration('fc')
  const lang = settings.get('lang')
  client = new LanguageClient(
    'fc',
    'fcproto',
    { command: settings.get('path'), args: ['lsp'] },
    {
      documentSelector: [{ scheme: 'file', language: 'yaml' }],
      initializationOptions: { showReferences: true, lang: lang === 'auto' ? vscode.env.language : lang },
    },
  )
  await client.start()
}

async function restart() {
  await client?.dispose()
  await start()
}

/** Called by the editor when it ends. */
function deactivate() {
  return client?.dispose()
}

module.exports = { activate, deactivate }
