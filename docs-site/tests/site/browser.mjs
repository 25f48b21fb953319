// The built site on a free port, and Debian's Chromium.

import { createReadStream, existsSync, statSync } from 'node:fs'
import http from 'node:http'
import path from 'node:path'
import { createGzip } from 'node:zlib'
import { chromium } from 'playwright-core'
import { dist, needs } from '../support.mjs'

const executablePath = process.env.FC_CHROMIUM ?? '/usr/bin/chromium'

/** Options of a test that drives the site. */
export const driven = needs(
  existsSync(executablePath) && existsSync(path.join(dist, 'index.html')),
  `needs ${executablePath} (apt-get install chromium) and the built site (npm run build)`,
)

const TYPES = {
  '.css': 'text/css', '.html': 'text/html; charset=utf-8', '.js': 'text/javascript', '.json': 'application/json',
  '.svg': 'image/svg+xml', '.woff2': 'font/woff2',
}

/** Serves a built site like a file server, compressed. */
export async function serve(folder = dist, base = '/') {
  const server = http.createServer((request, response) => {
    let name = decodeURIComponent(new URL(request.url, 'http://localhost').pathname)
    if (name.endsWith('/')) name += 'index.html'
    let file = path.join(folder, name.startsWith(base) ? name.slice(base.length) : '404')
    let status = 200
    if (!file.startsWith(folder) || !existsSync(file) || !statSync(file).isFile()) {
      status = 404
      file = path.join(folder, '404.html')
    }
    response.writeHead(status, {
      'content-type': TYPES[path.extname(file)] ?? 'application/octet-stream',
      'content-encoding': 'gzip',
    })
    createReadStream(file).pipe(createGzip()).pipe(response)
  })
  await new Promise((done) => server.listen(0, '127.0.0.1', done))
  return { base: `http://127.0.0.1:${server.address().port}`, close: () => new Promise((done) => server.close(done)) }
}

/** A browser without background requests. */
export const launch = () =>
  chromium.launch({
    executablePath,
    args: [
      '--headless', '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
      '--disable-component-update', '--disable-sync', '--disable-dev-shm-usage',
    ],
  })

/** Runs `use` with a site, a browser and a function that opens pages and collects their errors. */
export async function withSite(use, other = {}) {
  const site = await serve(other.dist, other.base)
  const browser = await launch()
  const faults = []
  try {
    const open = async (url, options = {}) => {
      const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, ...options })
      if (process.env.FC_PATIENCE) context.setDefaultTimeout(Number(process.env.FC_PATIENCE))
      const page = await context.newPage()
      page.on('console', (message) => {
        if (message.type() === 'error') faults.push(`${page.url()}: ${message.text()}`)
      })
      page.on('pageerror', (error) => faults.push(`${page.url()}: ${error.message}`))
      page.on('request', (request) => {
        if (!request.url().startsWith(site.base) && !/^(data|blob):/.test(request.url())) {
          faults.push(`${page.url()} asks ${request.url()}`)
        }
      })
      if (url) await page.goto(site.base + url, { waitUntil: 'load' })
      return page
    }
    await use({ base: site.base, browser, open, faults })
  } finally {
    await browser.close()
    await site.close()
  }
}

/** Waits until Vue controls the page. */
export const alive = (page) => page.waitForFunction(() => document.querySelector('#app')?.__vue_app__ !== undefined)
