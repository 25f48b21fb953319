// The frame lab in the page, with every golden frame.

import assert from 'node:assert/strict'
import { createHash, randomBytes } from 'node:crypto'
import { test } from 'node:test'
import { gzipSync } from 'node:zlib'
import { engine, vectors } from '../support.mjs'
import { alive, driven, withSite } from './browser.mjs'
import { html } from './site-pages.mjs'

async function laboratory(open, url = '/lab/index.html') {
  const page = await open(url)
  await alive(page)
  await page.locator('[data-field=hex]').waitFor()
  return page
}

/** Pastes each frame and reads the verdict. The first verdict may be late, because the page loads its decoder then. */
const judge = async (page, frames) => {
  await page.locator('[data-field=hex]').fill(frames[0])
  await page.locator('[data-out=fault]').waitFor({ state: 'attached' })
  return page.evaluate(async (frames) => {
    const box = document.querySelector('[data-field=hex]')
    const setter = Object.getOwnPropertyDescriptor(HTMLTextAreaElement.prototype, 'value').set
    const verdicts = []
    for (const frame of frames) {
      setter.call(box, frame)
      box.dispatchEvent(new Event('input', { bubbles: true }))
      await new Promise((done) => setTimeout(done))
      const out = document.querySelector('[data-out=fault]')
      verdicts.push({
        fault: out?.dataset.fault,
        frameFault: out?.dataset.frameFault,
        json: document.querySelector('[data-out=json]')?.textContent ?? null,
      })
    }
    return verdicts
  }, frames)
}

const lab = await engine()
const { codec, protocol } = lab
const command = protocol.operations.find(({ kind, code }) => kind === 'command' && code !== null)
const hexOf = (side, id, gzip = false) =>
  lab.hex(lab.messageFrame(codec, command, { side, id, gzip }, side === 'request' ? command.requestExample : command.responseExample))
const field = (role) => protocol.header.find((one) => one.role === role)
const bytesOf = (hex) => hex.trim().split(/\s+/).map((byte) => Number.parseInt(byte, 16))
/** The number in a header field of a frame in hex. */
const numberIn = (hex, role) => {
  const { offset, size } = field(role)
  return lab.readUint(Uint8Array.from(bytesOf(hex)).subarray(offset, offset + size), protocol.byteOrder)
}
/** The frame with its last byte changed, so that its digest is wrong. */
const spoiled = (hex) => hex.replace(/..$/, (byte) => (byte === '7D' ? '7C' : '7D'))

test('accepted frames are decoded, rejected ones refused by name', driven, async () => {
  await withSite(async ({ open, faults }) => {
    const page = await laboratory(open)
    const cases = vectors.flatMap((file) =>
      [...file.accepted.map((vector) => ({ ...vector, error: '' })), ...file.rejected]
        .filter(({ frame }) => frame !== undefined)
        .map((vector) => ({ ...vector, where: `${file.file} ${vector.name}`, alone: file.file === 'frames.json' })),
    )
    const verdicts = await judge(page, cases.map(({ frame }) => frame))
    const wrong = []
    let accepted = 0
    cases.forEach((vector, index) => {
      const verdict = verdicts[index]
      // Golden frames without an operation test the frame. An empty data area has no result code.
      const fault = vector.alone && vector.error === '' ? verdict.frameFault : verdict.fault
      if (fault !== vector.error) wrong.push(`${vector.where}: ${fault} instead of ${vector.error || 'none'}`)
      if (vector.error !== '') return
      accepted++
      if (vector.body !== undefined && JSON.stringify(JSON.parse(verdict.json || '{}')) !== JSON.stringify(vector.body)) {
        wrong.push(`${vector.where}: ${verdict.json}`)
      }
    })
    console.log(`# ${accepted} accepted, ${cases.length - accepted} rejected`)
    assert.deepEqual(wrong, [])
    assert.deepEqual(faults, [])
  })
})

test('examples become golden frames, and bodies without a code are checked', driven, async () => {
  await withSite(async ({ open, faults }) => {
    const page = await laboratory(open)
    const wrong = []
    let made = 0
    for (const file of vectors.filter(({ operation }) => operation)) {
      if (file.kind === 'stream') continue
      await page.locator('[data-field=operation]').selectOption(file.operation)
      for (const side of ['request', 'response']) {
        await page.locator('[data-field=side]').selectOption(side)
        const golden = file.accepted.find((vector) => vector.direction === side && vector.case === 'plain' && vector.frame)
        if (golden) {
          await page.locator('[data-field=id]').fill(String(numberIn(golden.frame.replace(/../g, '$& '), 'id')))
          const hex = (await page.locator('[data-out=frame]').textContent()).replace(/ /g, '').toLowerCase()
          if (hex !== golden.frame) wrong.push(`${file.operation} ${side}: ${hex}`)
          made++
        }
        const texts = [...file.accepted.map((vector) => ({ ...vector, error: null })), ...file.rejected].filter(
          (vector) => vector.text !== undefined && vector.direction === side,
        )
        for (const vector of texts) {
          await page.locator('[data-field=json]').fill(vector.text)
          const found = await page.evaluate(async () => {
            await new Promise((done) => setTimeout(done))
            return document.querySelector('[data-out=written] .bad code')?.textContent ?? null
          })
          if (found !== vector.error) wrong.push(`${file.operation} ${vector.name}: ${found} instead of ${vector.error}`)
        }
      }
    }
    console.log(`# ${made} frames made`)
    assert.deepEqual(wrong, [])
    assert.deepEqual(faults, [])
  })
})

test('the frame is shown as hex, C array and nc command', driven, async () => {
  await withSite(async ({ open }) => {
    const page = await laboratory(open, '/en/lab/index.html')
    await page.locator('[data-field=operation]').selectOption('get_robot_sn')
    const out = page.locator('[data-out=frame]')
    const hex = await out.textContent()
    const choose = async (name) => {
      await page.locator(`[data-form=${name}]`).click()
      await page.locator(`[data-form=${name}][aria-pressed=true]`).waitFor()
    }
    await choose('c')
    const c = await out.textContent()
    assert.match(c, /^static const unsigned char get_robot_sn_request\[60\] = \{/)
    assert.deepEqual(c.match(/0x../g).map((byte) => byte.slice(2)), hex.split(' '))
    await choose('nc')
    const nc = await out.textContent()
    assert.match(nc, /^printf '.*' \| nc -w 3 127\.0\.0\.1 \d+ \| xxd$/)
    assert.deepEqual(
      nc.match(/\\\d{3}/g).map((byte) => Number.parseInt(byte.slice(1), 8).toString(16).padStart(2, '0').toUpperCase()),
      hex.split(' '),
    )
    // The C array, pasted back, is the same frame.
    await page.locator('[data-field=hex]').fill(c)
    await page.locator('[data-out=overall][data-level=good]').waitFor()
    assert.equal(await page.locator('[data-out=json]').count(), 1)
  })
})

test('a byte lights its field and a field its bytes', driven, async () => {
  await withSite(async ({ open }) => {
    for (const url of ['/reference/commands/get_robot_sn.html', '/en/lab/index.html']) {
      const page = await open(url)
      await alive(page)
      const frame = page.locator('.fc-frame').first()
      await frame.waitFor()
      const lit = (what) => frame.locator(`${what}.on`)
      await frame.locator('.fc-byte').nth(3).hover()
      assert.deepEqual(await lit('.fc-parts li').locator('.fc-name').allTextContents(), ['cmdFunction'])
      assert.equal(await lit('.fc-byte').count(), 2)
      await frame.locator('.fc-parts li').last().hover()
      const data = await lit('.fc-byte').count()
      assert.equal(data, (await frame.locator('.fc-byte').count()) - 35)
      await page.mouse.move(0, 0)
      assert.equal(await lit('.fc-byte').count(), 0)
    }
  })
})

/** Opens the lab in both languages. */
const inBoth = async (open, use, options) => {
  for (const [url, english] of [['/lab/index.html', false], ['/en/lab/index.html', true]]) {
    const page = await open(url, options)
    await alive(page)
    await page.locator('[data-field=hex]').waitFor()
    await use(page, english)
    await page.context().close()
  }
}
const paste = (page, text) => page.locator('[data-field=hex]').fill(text)

test('the id of the box is the id of the frame', driven, async () => {
  await withSite(async ({ open }) => {
    const page = await laboratory(open)
    for (const id of [0, 305419896, 2 ** 32 - 1]) {
      await page.locator('[data-field=id]').fill(String(id))
      assert.equal(numberIn(await page.locator('[data-out=frame]').textContent(), 'id'), id)
    }
    // The frame has exactly the id in the box.
    await page.locator('[data-field=id]').fill(String(2 ** 32))
    await page.locator('[data-out=bad-id]').waitFor()
    await page.locator('[data-out=frame]').waitFor({ state: 'detached' })
  })
})

test('the gzip option packs the frame, and the frame opens again', driven, async () => {
  await withSite(async ({ open }) => {
    const page = await laboratory(open)
    const value = (role) => protocol.encodings.find((encoding) => encoding.role === role).value
    const made = page.locator('[data-out=frame]')
    assert.equal(numberIn(await made.textContent(), 'encoding'), value('plain'))
    await page.locator('[data-field=gzip]').check()
    assert.equal(numberIn(await made.textContent(), 'encoding'), value('gzip'), 'the frame says that it is packed')
    const sent = JSON.parse(await page.locator('[data-field=json]').inputValue())
    await page.locator('[data-do=decode]').click()
    assert.equal((await page.locator('[data-field=hex]').inputValue()), await made.textContent())
    assert.deepEqual(JSON.parse(await page.locator('[data-out=json]').textContent()), sent)
    await page.locator('[data-field=gzip]').uncheck()
    assert.equal(numberIn(await made.textContent(), 'encoding'), value('plain'))
  })
})

test('a failed check shows the expected and the found value', driven, async () => {
  await withSite(async ({ open }) => {
    await inBoth(open, async (page, english) => {
      const frame = hexOf('request', 1)
      const bad = spoiled(frame)
      await paste(page, bad)
      const { offset, size } = field('digest')
      const found = Buffer.from(bytesOf(frame).slice(offset, offset + size)).toString('hex')
      const expected = createHash('md5').update(Buffer.from(bytesOf(bad).slice(protocol.headerLength))).digest('hex')
      const said = await page.locator('[data-check=digest] small').textContent()
      assert.equal(said, english ? `expected ${expected}, found ${found}` : `应为 ${expected}，实为 ${found}`)
    })
  })
})

test('a failed check is crossed, earlier ones are ticked', driven, async () => {
  await withSite(async ({ open }) => {
    const page = await laboratory(open)
    const marks = () => page.locator('.fc-verdicts li').evaluateAll((all) => all.map((one) => [one.dataset.check, one.textContent.trim()[0]]))
    await paste(page, spoiled(hexOf('request', 1)))
    assert.deepEqual(await marks(), [['head', '✓'], ['length', '✓'], ['kind', '✓'], ['encoding', '✓'], ['digest', '✕']])
    await paste(page, hexOf('request', 1))
    assert.deepEqual((await marks()).map(([, mark]) => mark), ['✓', '✓', '✓', '✓', '✓', '✓'])
  })
})

test('only the bytes of the wrong field are highlighted', driven, async () => {
  await withSite(async ({ open }) => {
    const page = await laboratory(open)
    const red = () =>
      page.locator('.fc-lab .fc-byte').evaluateAll((all) => all.flatMap((byte, at) => (getComputedStyle(byte).outlineStyle === 'solid' ? [at] : [])))
    await paste(page, hexOf('request', 1))
    assert.deepEqual(await red(), [])
    await paste(page, spoiled(hexOf('request', 1)))
    const { offset, size } = field('digest')
    assert.deepEqual(await red(), Array.from({ length: size }, (_, index) => offset + index), 'the bytes of the digest are outlined')
  })
})

const { struct: envelope, code: role } = protocol.envelope.response
/** The key of the result code. */
const RESULT = envelope.fields[role].key

/** A response whose result code is not a number. */
function faulty() {
  const json = JSON.stringify({ ...JSON.parse(command.responseExample), [RESULT]: 'x' })
  return { json, hex: lab.hex(lab.messageFrame(codec, command, { side: 'response', id: 1, gzip: false }, json)) }
}

test('a fault in a body names the place', driven, async () => {
  await withSite(async ({ open }) => {
    await inBoth(open, async (page) => {
      await paste(page, faulty().hex)
      assert.equal(await page.locator('[data-out=findings] .bad .fc-path').textContent(), RESULT)
      await page.locator('[data-field=side]').selectOption('response')
      await page.locator('[data-field=operation]').selectOption(command.name)
      await page.locator('[data-field=json]').fill(faulty().json)
      assert.equal(await page.locator('[data-out=written] .bad .fc-path').textContent(), RESULT)
    })
  })
})

test('an error in a body has its message', driven, async () => {
  await withSite(async ({ open }) => {
    await inBoth(open, async (page, english) => {
      await paste(page, faulty().hex)
      const bad = page.locator('[data-out=findings] .bad')
      assert.equal(await bad.locator('code').textContent(), 'wrong_type')
      assert.equal(await bad.locator('.fc-why').textContent(), lab.errorText.wrong_type[english ? 'en' : 'zh'])
    })
  })
})

test('a capture is good only if every frame is', driven, async () => {
  await withSite(async ({ open, faults }) => {
    await inBoth(open, async (page, english) => {
      const overall = page.locator('[data-out=overall]')
      const verdict = async (text) => {
        await paste(page, text)
        return [await overall.getAttribute('data-level'), await overall.innerText()]
      }
      const request = hexOf('request', 7)
      const response = hexOf('response', 7)
      assert.equal((await verdict(request))[0], 'good')
      const [level, text] = await verdict(`${request} ${response}`)
      assert.equal(level, 'good')
      assert.match(text, english ? /^2 frames, all valid$/ : /^2 帧，全部正常$/)
      const [half, lost] = await verdict(`${request} ${response.slice(0, -36)}`)
      assert.equal(half, 'bad')
      assert.match(lost, english ? /incomplete, 12 bytes missing/ : /不完整，还差 12 字节/)
      const [skipped, where] = await verdict(`00 01 ${request}`)
      assert.equal(skipped, 'bad')
      assert.match(where, english ? /2 bytes at 0x0000 belong to no frame/ : /0x0000 起的 2 字节不属于任何一帧/)
      assert.equal((await verdict(`${request} ${spoiled(response)}`))[0], 'bad')
      // The reader sees the error first.
      assert.equal(await page.locator('[data-out=fault]').getAttribute('data-fault'), 'bad_digest')
    })
    assert.deepEqual(faults, [])
  })
})

test('each frame of a capture opens by mouse and keyboard', driven, async () => {
  await withSite(async ({ open }) => {
    const page = await laboratory(open)
    await paste(page, `${hexOf('request', 7)} ${hexOf('request', 8)} ${hexOf('response', 7)}`)
    const pieces = page.locator('[data-out=piece]')
    assert.equal(await pieces.count(), 3)
    const shown = async () => JSON.parse(await page.locator('[data-out=json]').textContent())
    await pieces.nth(2).click()
    assert.deepEqual(await shown(), JSON.parse(command.responseExample), 'the third frame is shown')
    assert.equal(await pieces.nth(2).getAttribute('aria-current'), 'true')
    await pieces.nth(0).focus()
    await page.keyboard.press('Enter')
    assert.deepEqual(await shown(), JSON.parse(command.requestExample))
  })
})

test('a long capture lists its first frames and the open one', driven, async () => {
  await withSite(async ({ open }) => {
    const page = await laboratory(open)
    const pieces = page.locator('[data-out=piece]')
    const current = page.locator('[data-out=piece][aria-current=true] .fc-number')
    const all = page.locator('[data-do=list-all]')
    const frame = hexOf('request', 7)
    const many = `${frame} `.repeat(300)
    await paste(page, many + spoiled(frame))
    assert.equal(await current.textContent(), '301', 'the frame at fault is in the list')
    assert.equal(await all.count(), 0)
    await paste(page, many)
    await all.waitFor()
    assert.ok((await pieces.count()) < 300)
    await all.click()
    assert.equal(await pieces.count(), 300)
    // A new capture shows its first frames.
    await paste(page, many + frame)
    await all.waitFor()
  })
})

test('a request leads to its response', driven, async () => {
  await withSite(async ({ open }) => {
    const page = await laboratory(open)
    await paste(page, `${hexOf('request', 7)} ${hexOf('request', 8)} ${hexOf('response', 7)}`)
    const chosen = () => page.locator('[data-out=piece]').evaluateAll((all) => all.findIndex((one) => one.ariaCurrent === 'true'))
    await page.locator('[data-do=partner]').click()
    assert.equal(await chosen(), 2)
    await page.locator('[data-do=partner]').click()
    assert.equal(await chosen(), 0)
    await page.locator('[data-out=piece]').nth(1).click()
    assert.equal(await page.locator('[data-do=partner]').count(), 0)
  })
})

test('invalid bytes are refused with the reason', driven, async () => {
  await withSite(async ({ open }) => {
    await inBoth(open, async (page, english) => {
      await paste(page, '{"cmdTime": 1}')
      assert.match(await page.locator('[data-out=refused]').textContent(), english ? /^This is JSON/ : /^这是 JSON/)
      assert.equal(await page.locator('[data-out=overall]').count(), 0)
    })
  })
})

test('without scripts the page asks for them', driven, async () => {
  for (const url of ['/lab/index.html', '/en/lab/index.html']) {
    assert.doesNotMatch(html(url), /data-out="(?:overall|piece|fault|findings|refused)"|fc-verdict|✓|✕/, url)
  }
  await withSite(async ({ open }) => {
    for (const [url, words] of [['/lab/index.html', /JavaScript/], ['/en/lab/index.html', /needs JavaScript/]]) {
      const page = await open(url, { javaScriptEnabled: false })
      assert.match(await page.locator('.fc-unscripted').innerText(), words)
      assert.equal(await page.locator('.fc-lab').isVisible(), false)
      const live = await open(url)
      await live.locator('[data-out=overall]').waitFor()
      assert.equal(await live.locator('.fc-unscripted').isVisible(), false)
    }
    // A frame on another page offers nothing that needs scripts.
    const page = await open('/en/reference/commands/get_cell_config.html', { javaScriptEnabled: false })
    assert.equal(await page.locator('.fc-frame button:visible, [data-do=open-in-lab]:visible').count(), 0)
    const bytes = await page.locator('.fc-frame').last().evaluate((frame) => [
      ...Array.from(frame.querySelectorAll('.fc-byte'), (byte) => byte.textContent),
      ...frame.querySelector('.fc-rest').lastChild.textContent.trim().split(' '),
    ])
    assert.equal(bytes.length, Number(/\d+/.exec(await page.locator('.fc-frame').last().locator('[role=img]').getAttribute('aria-label'))[0]))
  })
})

test('a file is opened, dropped or pasted', driven, async () => {
  await withSite(async ({ open, faults }) => {
    const page = await laboratory(open, '/en/lab/index.html')
    const overall = page.locator('[data-out=overall]')
    const bytes = Buffer.from([...bytesOf(hexOf('request', 7)), ...bytesOf(hexOf('response', 7))])
    const log = `17:40:01.123 [main] DEBUG fc.Client - sent ${hexOf('request', 7)}\n`
    const files = [
      ['frames.bin', bytes, '2 frames, all valid'],
      ['app.log', Buffer.from(log), '1 frame, valid'],
      ['app.log.gz', gzipSync(log), '1 frame, valid'],
    ]
    for (const [name, buffer, words] of files) {
      await page.locator('[data-do=clear]').click()
      await page.locator('[data-field=file]').setInputFiles({ name, mimeType: 'application/octet-stream', buffer })
      await overall.getByText(words).waitFor()
      for (const event of ['drop', 'paste']) {
        await page.locator('[data-do=clear]').click()
        await page.locator('[data-field=hex]').evaluate(
          (box, [event, name, bytes]) => {
            const data = new DataTransfer()
            data.items.add(new File([Uint8Array.from(bytes)], name))
            const given = event === 'drop' ? { dataTransfer: data } : { clipboardData: data }
            box.dispatchEvent(Object.assign(new (event === 'drop' ? DragEvent : ClipboardEvent)(event, { bubbles: true, cancelable: true, ...given })))
          },
          [event, name, [...buffer]],
        )
        await overall.getByText(words).waitFor()
      }
    }
    // The lab names a refused file until the next paste.
    const empty = Buffer.from('d4c3b2a1020004000000000000000000ffff000001000000', 'hex')
    await page.locator('[data-field=file]').setInputFiles({ name: 'a.pcap', mimeType: 'application/octet-stream', buffer: empty })
    await page.locator('[data-out=refused]').getByText('0 packets').waitFor()
    await paste(page, hexOf('request', 7))
    await overall.getByText('1 frame, valid').waitFor()
    assert.deepEqual(faults, [])
  })
})

const CLIPBOARD = { permissions: ['clipboard-read', 'clipboard-write'] }

test('the copy button copies the frame and confirms it', driven, async () => {
  await withSite(async ({ open }) => {
    for (const url of ['/lab/index.html', '/en/lab/index.html', '/reference/commands/get_robot_sn.html']) {
      const page = await open(url, CLIPBOARD)
      await alive(page)
      const view = page.locator('.fc-frame').first()
      await view.locator('[data-do=copy]').click()
      await view.locator('[data-out=copied]:not(:empty)').waitFor({ state: 'attached' })
      const bytes = await view.locator('.fc-byte').allTextContents()
      assert.equal(await page.evaluate(() => navigator.clipboard.readText()), bytes.join(' '), 'the clipboard has the frame')
      await page.context().close()
    }
  })
})

test('a frame is copied without a clipboard API', driven, async () => {
  await withSite(async ({ base, open }) => {
    const page = await open()
    // As on a page over plain http.
    await page.addInitScript(() => Object.defineProperty(Navigator.prototype, 'clipboard', { get: () => undefined }))
    await page.goto(`${base}/en/lab/index.html`)
    await alive(page)
    const button = page.locator('[data-panel=encode] [data-do=copy]')
    await button.click()
    await page.locator('[data-panel=encode] [data-out=copied]:not(:empty)').waitFor({ state: 'attached' })
    const frame = await page.locator('[data-out=frame]').textContent()
    const box = page.locator('[data-field=hex]')
    await box.fill('')
    await box.focus()
    await page.keyboard.press('Control+V')
    assert.equal(await box.inputValue(), frame, 'what is pasted is the frame')
    // If that is refused too, the selected text is shown.
    await page.evaluate(() => (document.execCommand = () => false))
    await button.click()
    await page.getByText('press Ctrl+C').waitFor()
    assert.equal(await page.evaluate(() => document.activeElement.value.slice(document.activeElement.selectionStart, document.activeElement.selectionEnd)), frame)
  })
})

test('a sample of JSON is copied without its comments', driven, async () => {
  await withSite(async ({ open }) => {
    const page = await open(`/reference/commands/${command.name}.html`, CLIPBOARD)
    await alive(page)
    const samples = page.locator('.language-jsonc')
    assert.match(await samples.last().textContent(), /\/\/ /)
    await samples.last().hover()
    await samples.last().locator('button.copy').click()
    await samples.last().locator('button.copied').waitFor()
    const copied = await page.evaluate(() => navigator.clipboard.readText())
    assert.deepEqual(JSON.parse(copied), JSON.parse(command.responseExample))
  })
})

test('comments in JSON are reported and removable', driven, async () => {
  await withSite(async ({ open }) => {
    await inBoth(open, async (page, english) => {
      const json = page.locator('[data-field=json]')
      await json.fill('{ "cmdTime": 1 // when\n}')
      assert.match(await page.locator('[data-out=comments]').textContent(), english ? /JSON has no comments/ : /JSON 没有注释/)
      await page.locator('[data-do=uncomment]').click()
      assert.deepEqual(JSON.parse(await json.inputValue()), { cmdTime: 1 })
      assert.equal(await page.locator('[data-out=comments]').count(), 0)
    })
  })
})

test('pasted input survives a reload', driven, async () => {
  await withSite(async ({ open }) => {
    const page = await laboratory(open)
    assert.equal(new URL(page.url()).hash, '')
    const text = `${hexOf('request', 7)}\n${hexOf('response', 7)}`
    await paste(page, text)
    await page.waitForURL((url) => url.hash.startsWith('#lab='))
    await page.reload()
    await alive(page)
    await page.waitForFunction((text) => document.querySelector('[data-field=hex]')?.value === text, text)
  })
})

test('input too long for an address is kept by the tab', driven, async () => {
  await withSite(async ({ open }) => {
    const page = await laboratory(open)
    const long = randomBytes(6000).toString('hex')
    await paste(page, long)
    await page.locator('[data-out=kept]').waitFor()
    assert.equal(new URL(page.url()).hash, '')
    await page.reload()
    await alive(page)
    await page.waitForFunction((text) => document.querySelector('[data-field=hex]')?.value === text, long)
  })
})

test('pasted input moves to the other language', driven, async () => {
  await withSite(async ({ open }) => {
    const page = await laboratory(open)
    const text = hexOf('response', 7)
    await paste(page, text)
    await page.waitForURL((url) => url.hash.startsWith('#lab='))
    await page.locator('.VPNavBarTranslations button').hover()
    const english = page.locator('.VPNavBarTranslations').getByText('English', { exact: true })
    assert.match(await english.evaluate((link) => link.closest('a').href), /#lab=/, 'the link to the other language carries it')
    await english.click()
    await page.waitForURL((url) => url.pathname.startsWith('/en/'))
    // The address changes before the page, so the language shows which page it is.
    await page.locator('[data-out=overall]').getByText('1 frame, valid').waitFor()
    assert.equal(await page.locator('[data-field=hex]').inputValue(), text)
  })
})

test('a link opens the laboratory with its input', driven, async () => {
  await withSite(async ({ open, faults }) => {
    const state = { paste: hexOf('response', 7), operation: command.name, side: 'response', id: 77, gzip: true, json: '{}' }
    const page = await laboratory(open, `/en/lab/index.html#${lab.toHash(state)}`)
    await page.waitForFunction((text) => document.querySelector('[data-field=hex]').value === text, state.paste)
    assert.equal(await page.locator('[data-field=operation]').inputValue(), state.operation)
    assert.equal(await page.locator('[data-field=side]').inputValue(), state.side)
    assert.equal(await page.locator('[data-field=id]').inputValue(), '77')
    assert.equal(await page.locator('[data-field=json]').inputValue(), '{}')
    assert.ok(await page.locator('[data-field=gzip]').isChecked())
    assert.deepEqual(faults, [])
  })
})

test('input and verdict are on the first screen of phone and tablet', driven, async () => {
  await withSite(async ({ open }) => {
    for (const viewport of [{ width: 390, height: 844 }, { width: 820, height: 1180 }, { width: 1440, height: 900 }]) {
      await inBoth(
        open,
        async (page) => {
          await paste(page, `00 ${hexOf('request', 7)} ${hexOf('response', 7).slice(0, -30)}`)
          await page.evaluate(() => scrollTo(0, 0))
          for (const what of ['[data-field=hex]', '[data-out=overall]']) {
            const box = await page.locator(what).boundingBox()
            assert.ok(box.y >= 0 && box.y + box.height <= viewport.height, `${what} ends at ${box.y + box.height} of ${viewport.height}`)
          }
          assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= viewport.width, 'nothing is wider than the screen')
        },
        { viewport },
      )
    }
  })
})
