// Breaks the site on purpose. The tests must notice each break.
//
// Each entry of the JSON files in this directory is a break. It replaces `find` by `replace` in `file`, a path relative
// to docs-site. The tests of `test` whose names match `pattern` must pass before the break and fail after it. If another
// break could be the cause, `says` is a text that the failure must contain. All changes happen in a copy.
//
// Tests under tests/site need a built site, and a build takes long. Breaks with different tests share a build. `--alone`
// gives each break its own build. `--green` assumes that all tests have just passed on the whole site. A word on the
// command line selects the breaks whose names contain it. `--check` only checks that each break can be applied.

import { spawn } from 'node:child_process'
import { cpSync, existsSync, mkdtempSync, readdirSync, readFileSync, rmSync, symlinkSync, writeFileSync } from 'node:fs'
import { availableParallelism, tmpdir } from 'node:os'
import path from 'node:path'
import { root, site } from '../support.mjs'

const here = path.join(site, 'tests/breaks')
const words = process.argv.slice(2).filter((argument) => !argument.startsWith('--'))
const alone = process.argv.includes('--alone')
const green = process.argv.includes('--green')
const KEYS = ['name', 'file', 'find', 'replace', 'test', 'pattern', 'says']

/** True if a pattern fits the title of a test. Titles made at run time fit every pattern. */
function fits(pattern, file) {
  const titles = readFileSync(path.join(site, file), 'utf8').matchAll(/\btest\((['`])(.*?)\1,/g)
  return [...titles].some(([, , title]) => title.includes('${') || new RegExp(pattern).test(title))
}

/** The reason why an entry cannot be applied. */
function slip(entry) {
  const strange = Object.keys(entry).filter((key) => !KEYS.includes(key))
  if (strange.length > 0) return `unknown key ${strange.join(', ')}`
  const lacks = ['name', 'file', 'find', 'replace', 'test'].filter((key) => typeof entry[key] !== 'string')
  if (lacks.length > 0) return `lacks ${lacks.join(', ')}`
  if (!existsSync(path.join(site, entry.file))) return `there is no ${entry.file}`
  if (!existsSync(path.join(site, entry.test))) return `there is no ${entry.test}`
  if (entry.pattern && !fits(entry.pattern, entry.test)) return `no test of ${entry.test} matches ${entry.pattern}`
  const times = readFileSync(path.join(site, entry.file), 'utf8').split(entry.find).length - 1
  return times === 1 ? null : `\`find\` stands ${times} times in ${entry.file}, and must stand there once`
}

const all = readdirSync(here)
  .filter((name) => name.endsWith('.json'))
  .sort()
  .flatMap((name) => JSON.parse(readFileSync(path.join(here, name), 'utf8')).map((entry) => ({ ...entry, from: name })))
const slips = all.map(({ from, ...entry }) => [`${from}: ${entry.name}`, slip(entry)]).filter(([, what]) => what)
const names = all.map(({ name }) => name)
names.filter((name, index) => names.indexOf(name) < index).forEach((name) => slips.push([name, 'this name is taken']))
if (slips.length > 0) {
  for (const [name, what] of slips) console.error(`${name}: ${what}`)
  process.exit(1)
}
if (process.argv.includes('--check')) process.exit(0)
const breaks = all.filter(({ name }) => words.every((word) => name.includes(word)))

const built = ({ test }) => test.startsWith('tests/site/')
const command = ({ test, pattern }) => JSON.stringify([test, pattern ?? ''])
/** Returns `true` if two entries run the same test. */
const meet = (a, b) => a.test === b.test && (a.pattern === b.pattern || a.pattern === undefined || b.pattern === undefined)

const children = new Set()

/** Runs a program. Returns its status and its output. */
const run = (program, args, cwd) =>
  new Promise((done) => {
    // A failing test should not wait as long as a slow one.
    const env = { ...process.env, FC_CI: '1', FC_PATIENCE: '12000', NO_COLOR: '1' }
    const child = spawn(program, args, { cwd, env, stdio: ['ignore', 'pipe', 'pipe'] })
    children.add(child)
    let said = ''
    for (const stream of [child.stdout, child.stderr]) stream.setEncoding('utf8').on('data', (text) => (said += text))
    child.on('close', (status) => {
      children.delete(child)
      done({ status, said })
    })
  })

/** Runs the tests of an entry. Returns the numbers of passed and failed tests. */
async function tested(entry, folder) {
  const pattern = entry.pattern === undefined ? [] : [`--test-name-pattern=${entry.pattern}`]
  const { said } = await run(process.execPath, ['--test', '--test-reporter=tap', ...pattern, entry.test], folder)
  const count = (what) => Number(new RegExp(`^# ${what} (\\d+)$`, 'm').exec(said)?.[1] ?? Number.NaN)
  return { passed: count('pass'), failed: count('fail'), said }
}

/** Runs as many items at once as there are processors, because a browser uses a whole one. */
async function each(items, work) {
  const waiting = [...items]
  const worker = async () => {
    for (let item = waiting.shift(); item !== undefined; item = waiting.shift()) await work(item)
  }
  await Promise.all(Array.from({ length: Math.max(1, Math.min(4, availableParallelism())) }, worker))
}

/** A copy of docs-site and stubs, with links to everything else that they read. */
function copy() {
  const folder = mkdtempSync(path.join(tmpdir(), 'fc-breaks-'))
  const mine = path.join(folder, path.basename(site))
  const copied = [path.basename(site), 'stubs']
  for (const name of readdirSync(root)) {
    if (!name.startsWith('.') && !copied.includes(name) && name !== 'target') symlinkSync(path.join(root, name), path.join(folder, name))
  }
  // A build of a package may run at the same time.
  const left = (source) => ['node_modules', 'build'].includes(path.basename(source)) || ['dist', 'cache', '.temp'].some((name) => source === path.join(site, '.vitepress', name))
  for (const name of copied) cpSync(path.join(root, name), path.join(folder, name), { recursive: true, filter: (source) => !left(source) })
  symlinkSync(path.join(site, 'node_modules'), path.join(mine, 'node_modules'))
  return { mine, remove: () => rmSync(folder, { recursive: true, force: true }) }
}

/** Applies breaks to a copy. Returns the function that undoes them, or `null` if one hides another. */
function apply(entries, mine) {
  const before = new Map()
  for (const { file, find, replace } of entries) {
    const place = path.join(mine, file)
    const text = readFileSync(place, 'utf8')
    if (!before.has(place)) before.set(place, text)
    if (!text.includes(find)) {
      before.forEach((whole, where) => writeFileSync(where, whole))
      return null
    }
    writeFileSync(place, text.replace(find, () => replace))
  }
  return () => before.forEach((whole, where) => writeFileSync(where, whole))
}

/** Entries that can share a build. */
function batches(entries, mine) {
  const made = []
  for (const entry of entries) {
    const fits = (batch) => {
      if (alone || batch.some((other) => meet(other, entry))) return false
      const back = apply([...batch, entry], mine)
      back?.()
      return back !== null
    }
    const batch = made.find(fits)
    if (batch) batch.push(entry)
    else made.push([entry])
  }
  return made
}

const verdicts = new Map()
const begun = Date.now()
const seconds = () => `${Math.round((Date.now() - begun) / 1000)} s`

/** Returns the result line of a break after its tests. */
function judge(entry, { failed, said }) {
  if (!(failed > 0)) return 'SURVIVED: no test fails'
  if (entry.says !== undefined && !said.includes(entry.says)) return `SURVIVED: the failure does not say ${JSON.stringify(entry.says)}\n${said}`
  return 'caught'
}

const { mine, remove } = copy()
let interrupted = false
process.on('SIGINT', () => {
  interrupted = true
  for (const child of children) child.kill()
})
try {
  // Without a break, the tests exist and pass.
  if (breaks.some(built) && !existsSync(path.join(site, '.vitepress/dist/index.html'))) throw new Error('build the site first: npm run build')
  const once = green ? [] : [...new Map(breaks.map((entry) => [command(entry), entry])).values()]
  const sick = []
  await each(once, async (entry) => {
    const { passed, failed, said } = await tested(entry, site)
    if (!(passed > 0 && failed === 0)) sick.push(`${command(entry)} does not pass on the whole site: passed ${passed}, failed ${failed}\n${said}`)
  })
  if (sick.length > 0) throw new Error(sick.join('\n'))
  if (!green) console.log(`${once.length} tests pass without a break (${seconds()})`)

  for (const entry of breaks.filter((entry) => !built(entry))) {
    const back = apply([entry], mine)
    verdicts.set(entry.name, judge(entry, await tested(entry, mine)))
    back()
  }
  const shared = batches(breaks.filter(built), mine)
  for (const [index, batch] of shared.entries()) {
    if (interrupted) break
    const back = apply(batch, mine)
    const { status, said } = await run(process.execPath, ['node_modules/vitepress/bin/vitepress.js', 'build'], mine)
    if (status !== 0) throw new Error(`the site with ${batch.map(({ name }) => name).join(', ')} does not build\n${said}`)
    console.log(`build ${index + 1} of ${shared.length} has ${batch.length} breaks (${seconds()})`)
    await each(batch, async (entry) => verdicts.set(entry.name, judge(entry, await tested(entry, mine))))
    back()
  }
} catch (problem) {
  console.error(problem.message)
  process.exitCode = 1
} finally {
  remove()
}

const width = Math.max(0, ...breaks.map(({ name }) => name.length))
for (const { name, test, pattern } of breaks) {
  console.log(`${name.padEnd(width)}  ${verdicts.get(name) ?? 'not tried'}  (${test}${pattern === undefined ? '' : `: ${pattern}`})`)
}
const caught = breaks.filter(({ name }) => verdicts.get(name) === 'caught').length
console.log(`${caught} of ${breaks.length} breaks caught in ${seconds()}`)
if (caught < breaks.length) process.exitCode = 1
