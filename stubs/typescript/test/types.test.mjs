// Types and their schemas: the compiler refuses differences, and accepted ones are read and written.

import { execFileSync } from 'node:child_process'
import { mkdirSync, rmSync, writeFileSync } from 'node:fs'
import path from 'node:path'
import { test } from 'node:test'
import { root } from './support.mjs'

const folder = path.join(root, 'dist/types')
const tsc = path.join(root, 'node_modules/.bin/tsc')

test('the compiler refuses a schema of another type', () => {
  rmSync(folder, { recursive: true, force: true })
  mkdirSync(folder, { recursive: true })
  const compilerOptions = { rootDir: path.join(root, 'test/types'), outDir: 'out', isolatedDeclarations: false }
  const include = [path.join(root, 'test/types/**/*.ts')]
  const config = { extends: '../../tsconfig.json', compilerOptions, include }
  writeFileSync(path.join(folder, 'tsconfig.json'), JSON.stringify(config))
  execFileSync(tsc, ['-p', folder], { stdio: ['ignore', 'inherit', 'inherit'] })
  execFileSync(process.execPath, [path.join(folder, 'out/messages.js')], { stdio: 'inherit' })
})

/** A program for browsers, which imports every module that browsers can use. */
const BROWSER = `
import { CallError, Client } from 'fc-protocol'
import { protocol } from 'fc-protocol/codec'
import { md5 } from 'fc-protocol/runtime'
import { webPlatform } from 'fc-protocol/web'

export async function robotSn(): Promise<string> {
  const client = await Client.connect(webPlatform((host, port) => \`wss://bridge/\${host}/\${port}\`))
  try {
    const { data } = await client.getRobotSn({}, { signal: new AbortController().signal })
    return data.robotSn
  } catch (problem) {
    return problem instanceof CallError ? problem.kind : \`\${protocol.title.en} \${md5(new Uint8Array()).length}\`
  }
}
`

for (const lib of ['ES2018', 'ES2022', 'ESNext']) {
  for (const [module, moduleResolution] of [
    ['ESNext', 'Bundler'],
    ['NodeNext', 'NodeNext'],
  ]) {
    test(`declarations_need_no_more_than_${lib}_and_dom_in_${module}`, () => {
      // Inside the package, so that the package's name resolves.
      const folder = path.join(root, 'dist/types', `browser-${lib}-${module}`)
      rmSync(folder, { recursive: true, force: true })
      mkdirSync(folder, { recursive: true })
      const compilerOptions = {
        target: 'ES2022',
        lib: [lib, 'DOM'],
        types: [],
        module,
        moduleResolution,
        strict: true,
        skipLibCheck: false,
        noEmit: true,
      }
      writeFileSync(path.join(folder, 'app.ts'), BROWSER)
      writeFileSync(path.join(folder, 'tsconfig.json'), JSON.stringify({ compilerOptions, include: ['app.ts'] }))
      execFileSync(tsc, ['-p', folder], { stdio: ['ignore', 'inherit', 'inherit'] })
    })
  }
}
