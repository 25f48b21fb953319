// The YAML of the spec as pages, so that every "defined in" leads to its line.

import { readdirSync, readFileSync } from 'node:fs'
import path from 'node:path'
import { fileURLToPath } from 'node:url'

const folder = fileURLToPath(new URL('../../spec', import.meta.url))

/** Root-relative names of the spec's files without their ending, `commands/cell`. */
export function specFiles(): string[] {
  const files = readdirSync(folder, { recursive: true, encoding: 'utf8' })
  return files
    .map((file) => file.split(path.sep).join('/'))
    .filter((file) => file.endsWith('.yaml'))
    .map((file) => file.slice(0, -'.yaml'.length))
    .sort()
}

/** One page a file. */
export function specPages() {
  return specFiles().map((file) => {
    const text = readFileSync(path.join(folder, `${file}.yaml`), 'utf8')
    const ticks = '`'.repeat(4)
    return { params: { file, title: `spec/${file}.yaml` }, content: `${ticks}yaml\n${text.trimEnd()}\n${ticks}` }
  })
}
