// The laboratory in the page, against every golden vector.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import { vectors } from '../support.mjs'
import { alive, driven, withSite } from './browser.mjs'

async function laboratory(open, url = '/lab/index.html') {
  const page = await open(url)
  await alive(page)
  await page.locator('[data-field=hex]').waitFor()
  return page
}

/** Pastes each frame and reads the verdict. */
const judge = (page, frames) =>
  page.evaluate(async (frames) => {
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

test('every accepted frame is decoded, every rejected one refused by its name', driven, async () => {
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
      // Vectors of no operation are about the frame; an empty data area has no result code.
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

test('every example becomes the golden frame, and bodies without a code are judged all the same', driven, async () => {
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

test('the frame comes as hex, as a C array and as a line for nc', driven, async () => {
  await withSite(async ({ open }) => {
    const page = await laboratory(open, '/en/lab/index.html')
    await page.locator('[data-field=operation]').selectOption('get_robot_sn')
    const out = page.locator('[data-out=frame]')
    const hex = await out.textContent()
    const tab = page.getByRole('tab')
    await tab.nth(1).click()
    const c = await out.textContent()
    assert.match(c, /^static const unsigned char get_robot_sn_request\[60\] = \{/)
    assert.deepEqual(c.match(/0x../g).map((byte) => byte.slice(2)), hex.split(' '))
    await tab.nth(2).click()
    const nc = await out.textContent()
    assert.match(nc, /^printf '.*' \| nc -w 3 127\.0\.0\.1 \d+ \| xxd$/)
    assert.deepEqual(
      nc.match(/\\\d{3}/g).map((byte) => Number.parseInt(byte.slice(1), 8).toString(16).padStart(2, '0').toUpperCase()),
      hex.split(' '),
    )
    // The C array, pasted back, is the same frame.
    await page.locator('[data-field=hex]').fill(c)
    await page.locator('[data-out=fault][data-fault=""]').waitFor()
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
