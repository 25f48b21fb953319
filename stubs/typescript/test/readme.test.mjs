// The programs of the READMEs, type-checked as in a user's strict project, and run: they print the text below them.

import assert from 'node:assert/strict'
import { execFileSync } from 'node:child_process'
import { mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs'
import path from 'node:path'
import { test } from 'node:test'
import { root } from './support.mjs'

/** Returns each program with its output. */
const programs = (text) =>
  [...text.matchAll(/\n```ts\n([^]*?)\n```\n+```text\n([^]*?\n)```\n/g)].map(([, code, output]) => ({ code, output }))

for (const name of ['README.md', 'README.zh-CN.md']) {
  test(name, () => {
    const text = readFileSync(path.join(root, name), 'utf8')
    const all = programs(text)
    assert.ok(all.length > 0)
    assert.equal(text.split('```ts\n').length - 1, all.length, 'a program without its output')
    // Inside the package, so that the package's name resolves.
    const folder = path.join(root, 'dist/readme', name)
    rmSync(folder, { recursive: true, force: true })
    mkdirSync(folder, { recursive: true })
    all.forEach(({ code }, index) => writeFileSync(path.join(folder, `program${index}.ts`), `${code}\n`))
    const compilerOptions = { rootDir: '.', outDir: 'out', skipLibCheck: false, isolatedDeclarations: false }
    const config = { extends: '../../../tsconfig.json', compilerOptions, include: ['*.ts'] }
    writeFileSync(path.join(folder, 'tsconfig.json'), JSON.stringify(config))
    execFileSync(path.join(root, 'node_modules/.bin/tsc'), ['-p', folder], { stdio: ['ignore', 'inherit', 'inherit'] })
    all.forEach(({ output }, index) => {
      const printed = execFileSync(process.execPath, [path.join(folder, `out/program${index}.js`)], {
        encoding: 'utf8',
      })
      assert.equal(printed, output)
    })
  })
}
