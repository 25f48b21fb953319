// Types and their schemas: the compiler refuses those that differ, and what it takes is read and written.

import { execFileSync } from 'node:child_process'
import { mkdirSync, rmSync, writeFileSync } from 'node:fs'
import path from 'node:path'
import { test } from 'node:test'
import { root } from './support.mjs'

const folder = path.join(root, 'dist/types')
const tsc = path.join(root, 'node_modules/.bin/tsc')

test('a schema that is none of its type is refused by the compiler', () => {
  rmSync(folder, { recursive: true, force: true })
  mkdirSync(folder, { recursive: true })
  const compilerOptions = { rootDir: path.join(root, 'test/types'), outDir: 'out', isolatedDeclarations: false }
  const include = [path.join(root, 'test/types/**/*.ts')]
  const config = { extends: '../../tsconfig.json', compilerOptions, include }
  writeFileSync(path.join(folder, 'tsconfig.json'), JSON.stringify(config))
  execFileSync(tsc, ['-p', folder], { stdio: ['ignore', 'inherit', 'inherit'] })
  execFileSync(process.execPath, [path.join(folder, 'out/messages.js')], { stdio: 'inherit' })
})
