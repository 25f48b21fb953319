// Reports to an app, and processes followed to their end.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import { bodyOf, client, drive, KINDS, moved, pipe, progress, Raw, settle } from './toy.mjs'

const report = (code, id) => ({ kind: KINDS.report, code, id })
const results = (raw) => raw.take().map((frame) => [frame.id.id, bodyOf(frame).result])

test('receivers get all or one kind of report, and unknown ones raw', async () => {
  const { raw, connection } = await client()
  const [all, some] = [connection.reports(), connection.reports(moved)]
  const heard = []
  const stop = connection.on(moved, ({ metres }) => {
    heard.push(metres)
    if (metres === 1) throw new Error('a listener may throw')
  })
  await raw.send(report(moved.code, 1), { metres: 1, more: null })
  await raw.send(report(999, 2), '{"any": [1.0]}')
  await raw.send(report(moved.code, 3), { metres: 2 })
  await settle()
  stop()
  assert.deepEqual(results(raw), [
    [1, 0],
    [2, 0],
    [3, 0],
  ])
  const { value: first } = await all.next()
  assert.deepEqual(first, {
    case: 'Moved',
    value: { metres: 1, extra: [{ key: 'more', json: 'null' }] },
    code: 300,
    id: 1,
    time: null,
  })
  const { value: unknown } = await all.next()
  assert.deepEqual([unknown.case, unknown.value, unknown.code], ['Unknown', '{"any":[1.0]}', 999])
  assert.equal((await some.next()).value.metres, 1)
  assert.equal((await some.next()).value.metres, 2)
  assert.deepEqual(heard, [1, 2])
  await raw.send(report(moved.code, 4), { metres: 3 })
  await settle()
  assert.deepEqual(heard, [1, 2])
})

test('an untaken report is not acknowledged, an unreadable one refused', async () => {
  const { raw, connection } = await client({ limits: { queuedReports: 1 } })
  await raw.send(report(moved.code, 1), { metres: 1 })
  await settle()
  assert.deepEqual(results(raw), [])
  const [slow, quick] = [connection.reports(), connection.reports()]
  await raw.send(report(moved.code, 1), { metres: 1 })
  await settle()
  await quick.next()
  await raw.send(report(moved.code, 2), { metres: 2 })
  await raw.send(report(moved.code, 3), { metres: 'far' })
  await settle()
  assert.deepEqual(results(raw), [
    [1, 0],
    [2, 0],
    [3, 3],
  ])
  assert.equal(slow.missed(), 1)
  assert.equal(slow.missed(), 0)
  const { reports, reportsMissed, reportsRefused, reportsInvalid } = connection.counters()
  assert.deepEqual([reports, reportsMissed, reportsRefused, reportsInvalid], [2, 1, 1, 1])
})

test('a report later than its interval is counted', async () => {
  const { raw, connection, clock } = await client()
  const reports = connection.reports()
  for (const [wait, id] of [
    [0, 1],
    [1500, 2],
    [1501, 3],
  ]) {
    await clock.advance(wait)
    await raw.send(report(302, id), { metres: id })
    await settle()
  }
  assert.equal(connection.counters().reportsLate, 1)
  assert.equal((await reports.next()).value.case, 'Beat')
})

/** Starts a drive and gets its response. */
async function begun(config) {
  const all = await client(config)
  const call = all.connection.call(drive, { metres: 5 }).follow()
  await settle()
  await all.raw.send(report(progress.code, 1), { drive: 7, state: 0 })
  await all.raw.answer(all.raw.take()[0], { result: 0, drive: 7 })
  return { ...all, following: await call }
}

test('following has the reports from before the response to the end', async () => {
  const { raw, connection, following } = await begun()
  assert.deepEqual(following.answer, { drive: 7 })
  for (const [id, body] of [
    { drive: 8, state: 2 },
    { drive: 7 },
    { drive: 7, state: 1 },
    { drive: 7, state: 0 },
    { drive: 7, state: 2 },
    { drive: 7, state: 2 },
  ].entries()) {
    await raw.send(report(progress.code, 10 + id), body)
  }
  const got = []
  for await (const next of following) got.push([next.is, next.report.state])
  assert.deepEqual(got, [
    ['going', 0],
    ['going', undefined],
    ['going', 1],
    ['going', 0],
    ['ended', 2],
  ])
  // One returned to an earlier state, and one skipped states.
  assert.equal(connection.counters().reportsOutOfOrder, 2)
  raw.take()
  await raw.send(report(progress.code, 99), { drive: 7, state: 1 })
  await settle()
  assert.deepEqual(results(raw), [], 'nobody takes it any more')
})

test('a failure ends following, losses are told in order', async () => {
  const { raw, platform, connection, following } = await begun({ limits: { queuedReports: 2 } })
  const other = connection.reports(progress)
  await raw.send(report(progress.code, 2), { drive: 7, state: 1 })
  await settle()
  await other.next()
  await raw.send(report(progress.code, 3), { drive: 7, state: 1 })
  await settle()
  assert.deepEqual((await following.next()).value.is, 'going')
  assert.deepEqual((await following.next()).value.is, 'going')
  assert.deepEqual((await following.next()).value, { is: 'missed', count: 1 })
  raw.end.close()
  await settle()
  const [theirs, ours] = pipe()
  platform.give(theirs)
  const again = new Raw(ours)
  await settle()
  await again.send(report(progress.code, 4), { drive: 7, state: 3 })
  const { value: cut } = await following.next()
  assert.equal(cut.is, 'interrupted')
  assert.deepEqual((await following.next()).value, { is: 'resumed' })
  assert.equal((await following.next()).value.is, 'failed')
  assert.equal((await following.next()).done, true)
})

test('following ends with the connection or its reader', async () => {
  const { connection, following } = await begun()
  await following.next()
  connection.close()
  await assert.rejects(following.next(), { name: 'FollowError', kind: 'closed' })
  assert.equal((await following.next()).done, true)
  const one = await begun()
  for await (const next of one.following) {
    assert.equal(next.is, 'going')
    break
  }
  assert.equal((await one.following.next()).done, true)
})

test('a refused command is not followed', async () => {
  const { raw, connection } = await client()
  const call = connection.call(drive, { metres: 5 }).follow()
  await settle()
  await raw.answer(raw.take()[0], { result: 2 })
  await assert.rejects(call, { kind: 'refused' })
  await raw.send(report(progress.code, 1), { drive: 7 })
  await settle()
  assert.deepEqual(results(raw), [], 'its queue is gone')
  const late = connection.call(drive, { metres: 5 })
  await settle()
  await assert.rejects(late.follow(), TypeError)
  late.catch(() => {})
  connection.close()
})
