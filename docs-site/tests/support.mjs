// Shared by several tests: the engine of the lab, the golden frames, and the conditions for skipping a test.

import { build } from 'esbuild'
import { existsSync, readdirSync, readFileSync } from 'node:fs'
import { fileURLToPath } from 'node:url'
import path from 'node:path'

/** `docs-site/`. */
export const site = fileURLToPath(new URL('..', import.meta.url)).replace(/\/$/, '')
/** The project's root. */
export const root = path.dirname(site)
/** The built site. */
export const dist = path.join(site, '.vitepress/dist')

/** CI skips no test. */
export const obligatory = process.env.FC_CI === '1'

/** Options for a test with a need: a reason to skip it on this machine, or none. */
export function needs(there, what) {
  if (there) return {}
  if (obligatory) throw new Error(`${what}, and CI skips nothing`)
  return { skip: what }
}

/** TypeScript modules of the site, compiled and loaded. */
export async function load(source) {
  const { outputFiles } = await build({
    stdin: { contents: source, resolveDir: site, loader: 'ts' },
    bundle: true,
    format: 'esm',
    platform: 'neutral',
    mainFields: ['module', 'main'],
    write: false,
  })
  return import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].contents).toString('base64')}`)
}

/** The engine of the lab, with its TypeScript package. */
export const engine = () =>
  load(`
    export * from './lab/codec'
    export * from './lab/fc'
    export * from './lab/engine/capture'
    export * from './lab/engine/parts'
    export * from './lab/engine/paste'
    export * from './lab/engine/spelling'
    export * from './lab/engine/state'
    export * from './lab/engine/text'
  `)

const folder = path.join(root, 'fc-generated/vectors')

/** Every golden vector file: `{ operation, code, accepted, rejected }`. */
export const vectors = existsSync(folder)
  ? readdirSync(folder)
      .filter((name) => name.endsWith('.json'))
      .sort()
      .map((name) => ({ file: name, ...JSON.parse(readFileSync(path.join(folder, name), 'utf8')) }))
  : []
