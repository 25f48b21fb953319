// Writes the reference of each package into the built site, by the tool of its language: `npm run build && npm run api`.
// A word on the command line chooses a language.

import { spawnSync } from 'node:child_process'
import { cpSync, mkdirSync, rmSync } from 'node:fs'
import { fileURLToPath } from 'node:url'
import path from 'node:path'
import { faults } from './doxygen.mjs'

const here = path.dirname(fileURLToPath(import.meta.url))
const site = path.dirname(here)
const root = path.dirname(site)
const target = path.resolve(root, process.env.CARGO_TARGET_DIR ?? 'target')

/** Runs a program and fails if it fails. */
function run(program, args, { cwd = root, ...env } = {}) {
  const { status, error } = spawnSync(program, args, { cwd, stdio: 'inherit', env: { ...process.env, ...env } })
  if (error) throw error
  if (status !== 0) process.exit(status ?? 1)
}

/** The functions that write the pages of a package into an empty folder. */
const LANGUAGES = {
  rust(folder) {
    // Old pages of other crates would be in the index.
    rmSync(path.join(target, 'doc'), { recursive: true, force: true })
    run('cargo', ['doc', '--quiet', '--locked', '--no-deps', '--all-features', '-p', 'fc-generated', '-p', 'fc-runtime'])
    cpSync(path.join(target, 'doc'), folder, { recursive: true })
  },
  typescript(folder) {
    run(path.join(site, 'node_modules/.bin/typedoc'), ['--options', path.join(here, 'typedoc.json'), '--out', folder])
  },
  python(folder) {
    const venv = path.join(site, '.vitepress/cache/pdoc')
    const requirements = path.join(here, 'requirements.txt')
    run('python3', ['-m', 'venv', venv])
    run(path.join(venv, 'bin/pip'), ['install', '--quiet', '--disable-pip-version-check', '--requirement', requirements])
    const packages = ['fc', 'fc_runtime']
    run(path.join(venv, 'bin/python'), [path.join(here, 'packages.py'), '--no-show-source', '--output-directory', folder, ...packages], {
      PYTHONPATH: path.join(root, 'stubs/python/src'),
      PYTHONDONTWRITEBYTECODE: '1',
    })
  },
  cpp(folder) {
    mkdirSync(folder, { recursive: true })
    const { status, error, stderr } = spawnSync('doxygen', [path.join(here, 'doxygen.conf')], {
      cwd: root,
      encoding: 'utf8',
      stdio: ['ignore', 'inherit', 'pipe'],
      maxBuffer: 1 << 26,
      env: { ...process.env, FC_API: folder },
    })
    if (error) throw error
    const found = faults(stderr.replaceAll(`${root}/`, ''))
    if (found.length > 0) console.error(found.join('\n'))
    if (status !== 0 || found.length > 0) process.exit(status || 1)
  },
}

const asked = process.argv.slice(2)
const strange = asked.filter((language) => !(language in LANGUAGES))
if (strange.length > 0) {
  console.error(`no package in ${strange.join(', ')}; there are ${Object.keys(LANGUAGES).join(', ')}`)
  process.exit(2)
}
for (const language of asked.length > 0 ? asked : Object.keys(LANGUAGES)) {
  const folder = path.join(site, '.vitepress/dist/api', language)
  rmSync(folder, { recursive: true, force: true })
  LANGUAGES[language](folder)
}
