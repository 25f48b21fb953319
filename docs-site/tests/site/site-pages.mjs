// The pages of the built site.

import { readdirSync, readFileSync } from 'node:fs'
import path from 'node:path'
import { dist } from '../support.mjs'

/** Returns `true` for a page of another tool: the reference of a package. */
export const isOfTools = (url) => url.startsWith('/api/')

/** Paths of all pages except those of other tools. */
export const pages = () =>
  readdirSync(dist, { recursive: true, encoding: 'utf8' })
    .map((file) => '/' + file.split(path.sep).join('/'))
    .filter((file) => file.endsWith('.html') && file !== '/404.html' && !isOfTools(file))

/** The HTML of a page. */
export const html = (url) => readFileSync(path.join(dist, url), 'utf8')

/** The page of a language with the largest count. */
export function pageWithMost(count, language) {
  const mine = pages().filter((url) => url.startsWith('/en/') === (language === 'en'))
  return mine.map((url) => [count(html(url)), url]).sort(([a], [b]) => b - a)[0][1]
}
