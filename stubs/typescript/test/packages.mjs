// Packages of other protocols: what is generated beside the runtime of this one, compiled as a team would compile it.

import assert from 'node:assert/strict'
import { execFileSync, spawnSync } from 'node:child_process'
import { cpSync, existsSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs'
import path from 'node:path'
import { pathToFileURL } from 'node:url'
import { root } from './support.mjs'

const tsc = path.join(root, 'node_modules/.bin/tsc')

/** The folder of the repository. */
export const repository = path.join(root, '../..')

/** The generator, which the environment may name; null where it has not been built. */
export const generator = (() => {
  const usual = path.join(repository, 'target/debug/fcproto')
  return process.env.FC ?? (existsSync(usual) ? usual : null)
})()

/** Why a test that needs the generator is left out; false where it is there. */
export const unlessGenerated = generator === null ? 'the generator is not built: cargo build -p fc-cli' : false

/** An empty folder of this name. */
export function emptyFolder(name) {
  const folder = path.join(root, 'dist/packages', name)
  rmSync(folder, { recursive: true, force: true })
  mkdirSync(folder, { recursive: true })
  return folder
}

/** What the generator says of a project whose spec and `fc.yaml` are in this folder. Throws if it finds a fault. */
export function generate(folder) {
  return execFileSync(generator, ['generate', '--root', folder], { encoding: 'utf8' })
}

/** What the compiler says of a folder with `generated` and programs beside it; the empty text if it is content. */
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

/** A module of a folder that has been compiled. */
export function load(folder, file) {
  return import(pathToFileURL(path.join(folder, 'out', file)))
}

/** A folder with the spec of one of the other protocols, changed file by file, and the package made of it. */
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

/** The text of the meter's commands with one text in the place of another; other files stay as they are. */
export const replaced = (from, to) => (text, file) => {
  if (!file.endsWith('power.yaml')) return text
  assert.ok(text.includes(from), from)
  return text.replaceAll(from, to)
}
