// Packages of other protocols: the generated files with this runtime, compiled as a team would do it.

import assert from 'node:assert/strict'
import { execFileSync, spawnSync } from 'node:child_process'
import { cpSync, existsSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs'
import path from 'node:path'
import { pathToFileURL } from 'node:url'
import { root } from './support.mjs'

const tsc = path.join(root, 'node_modules/.bin/tsc')

/** The folder of the repository. */
export const repository = path.join(root, '../..')

/** Path of the generator, which the environment may set; null if it is not built. */
export const generator = (() => {
  const usual = path.join(repository, 'target/debug/fcproto')
  return process.env.FC ?? (existsSync(usual) ? usual : null)
})()

/** Reason to skip a test that needs the generator; false if it is built. */
export const unlessGenerated = generator === null ? 'the generator is not built: cargo build -p fc-cli' : false

/** Returns an empty folder with this name. */
export function emptyFolder(name) {
  const folder = path.join(root, 'dist/packages', name)
  rmSync(folder, { recursive: true, force: true })
  mkdirSync(folder, { recursive: true })
  return folder
}

/** Returns the generator's output for the spec and `fc.yaml` in this folder. Throws if it finds an error. */
export function generate(folder) {
  return execFileSync(generator, ['generate', '--root', folder], { encoding: 'utf8' })
}

/** Returns the compiler's output for a folder with `generated` and programs; empty if there are no errors. */
export function compile(folder) {
  cpSync(path.join(root, 'src'), path.join(folder, 'src'), { recursive: true })
  const config = {
    extends: '../../../tsconfig.json',
    compilerOptions: { rootDir: '.', outDir: 'out', skipLibCheck: true },
    include: ['**/*.ts'],
    exclude: ['out'],
  }
  writeFileSync(path.join(folder, 'tsconfig.json'), JSON.stringify(config))
  writeFileSync(path.join(folder, 'package.json'), '{ "type": "module" }')
  const { stdout, stderr, error } = spawnSync(tsc, ['-p', '.'], { cwd: folder, encoding: 'utf8' })
  if (error) throw error
  return stdout + stderr
}

/** Returns a module of a compiled folder. */
export function load(folder, file) {
  return import(pathToFileURL(path.join(folder, 'out', file)))
}

/** Makes a folder with the spec of one of the other protocols, changed file by file, and generates its package. */
export function packageOf(name, protocol, change) {
  const folder = emptyFolder(name)
  cpSync(path.join(repository, 'fc-generated/tests', protocol, 'spec'), path.join(folder, 'spec'), { recursive: true })
  for (const file of readdirSync(path.join(folder, 'spec'), { recursive: true })) {
    if (!file.endsWith('.yaml')) continue
    const place = path.join(folder, 'spec', file)
    writeFileSync(place, change(readFileSync(place, 'utf8'), file))
  }
  writeFileSync(path.join(folder, 'fc.yaml'), 'targets: { typescript: { out: generated } }\n')
  return folder
}

/** Replaces a text in the meter's commands. Other files do not change. */
export const replaced = (from, to) => (text, file) => {
  if (!file.endsWith('power.yaml')) return text
  assert.ok(text.includes(from), from)
  return text.replaceAll(from, to)
}
