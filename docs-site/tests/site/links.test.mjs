// Every link of the built site leads to an existing page and anchor.

import assert from 'node:assert/strict'
import { existsSync, readdirSync, readFileSync } from 'node:fs'
import path from 'node:path'
import { test } from 'node:test'
import { dist, needs } from '../support.mjs'
import { isOfTools } from './site-pages.mjs'

const built = needs(existsSync(path.join(dist, 'index.html')), 'needs the built site (npm run build)')

const decode = (text) => text.replace(/&amp;/g, '&').replace(/&quot;/g, '"').replace(/&#39;/g, "'")

test('links and anchors resolve, and no file is from another host', built, () => {
  const files = readdirSync(dist, { recursive: true, encoding: 'utf8' }).map((file) => '/' + file.split(path.sep).join('/'))
  const ids = new Map()
  const html = new Map()
  for (const file of files.filter((file) => file.endsWith('.html') && !isOfTools(file))) {
    const text = readFileSync(path.join(dist, file), 'utf8')
    html.set(file, text)
    ids.set(file, new Set(Array.from(text.matchAll(/ id="([^"]*)"/g), ([, id]) => decode(id))))
  }
  const all = new Set(files)
  // Another test covers the references of the packages.
  const referenced = files.some(isOfTools)
  const dead = []
  let links = 0
  for (const [file, text] of html) {
    for (const [, name, raw] of text.matchAll(/ (href|src)="([^"]*)"/g)) {
      const url = new URL(decode(raw), `http://site${file}`)
      if (url.host !== 'site') {
        dead.push(`${file}: ${raw} is on another host`)
        continue
      }
      links++
      let target = decodeURIComponent(url.pathname)
      if (target.endsWith('/')) target += 'index.html'
      if (isOfTools(target) && !referenced) continue
      if (!all.has(target)) dead.push(`${file}: ${raw} leads nowhere`)
      // The lab opens the bytes of a frame; they are not an anchor.
      else if (name === 'href' && url.hash && !/\/lab\/index\.html#hex=/.test(raw) && ids.has(target) && !ids.get(target).has(decodeURIComponent(url.hash.slice(1)))) {
        dead.push(`${file}: ${raw} has no such anchor`)
      }
    }
  }
  console.log(`# ${links} links on ${html.size} pages`)
  assert.deepEqual([...new Set(dead)].slice(0, 40), [])
})
