// The pages of the built site.

import { readdirSync } from 'node:fs'
import path from 'node:path'
import { dist } from '../support.mjs'

/** Paths of all pages. */
export const pages = () =>
  readdirSync(dist, { recursive: true, encoding: 'utf8' })
    .map((file) => '/' + file.split(path.sep).join('/'))
    .filter((file) => file.endsWith('.html') && file !== '/404.html')
