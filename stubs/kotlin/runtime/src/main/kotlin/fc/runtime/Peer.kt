package fc.runtime

import java.net.SocketAddress
import java.util.concurrent.CancellationException
import kotlinx.coroutines.CoroutineStart
import kotlinx.coroutines.Job
import kotlinx.coroutines.launch

/** One app's command connection at a robot. */
internal class Peer(
    private val server: ServerCore,
    link: Link,
    val id: Long,
    val address: SocketAddress?,
    /** What may be called from its address. */
    private val effects: Set<Effect>,
) : Conversation(server.loop, link, server.config.decoder(server.protocol)) {
    private class Work(val job: Job, val context: Context, val effect: Effect) {
        var deadline: Timer? = null
    }

    private val protocol = server.protocol
    private val config = server.config
    private val limits = server.limits
    private val session =
        Session<Queued>(protocol, limits, protocol.defaults.ack, config.firstId ?: idOfNow())
    private val queue = ArrayDeque<Queued>()

    /** Bytes of the reports in the queue and in flight. */
    private var queuedBytes = 0L
    private val mostQueuedBytes = config.queuedBytes ?: limits.inflatedBytes
    private val working = HashMap<FrameId, Work>()
    private var isDraining = false

    /** Nothing more is read at all. What has been carried out is answered all the same. */
    private var isDeaf = false
    private var headerSince = -1L
    private val arriving = RateWatch(config.leastRate, config.stallTimeout)
    private val leaving = RateWatch(config.leastRate, config.stallTimeout)
    private val pace = Pace()
    private var wasReading = true
    private var lastFrame = loop.now

    /** Something has been received. */
    var isHeard = false
        private set

    override fun reads(): Boolean =
        !isDraining && !isDeaf && working.size < limits.inFlight && unsent < HIGH_WATER && pace.until <= loop.now

    override fun came(bytes: Int, isFirst: Boolean, now: Long) {
        isHeard = true
        server.counting.add(ServerCount.BYTES_IN, bytes.toLong())
        if (isFirst) arriving.begin(now) else arriving.add(bytes, now)
    }

    override fun begins(now: Long): Unit = leaving.begin(now)

    override fun wrote(bytes: Int, now: Long): Unit = leaving.add(bytes, now)

    override fun sent(bytes: Int): Unit = server.counting.add(ServerCount.BYTES_OUT, bytes.toLong())

    override fun ended(end: End) {
        if (end is End.Broken) return goAtOnce()
        if ((end as End.Deaf).error != null) server.counting.add(ServerCount.BAD_FRAMES)
        isDeaf = true
    }

    override fun skipped(error: FrameError, now: Long) {
        whole(now)
        server.counting.add(ServerCount.BAD_FRAMES)
        unusable()
        error.frame?.takeIf { !it.isResponse }?.let { refuse(it, protocol.results.protocol) }
    }

    private fun whole(now: Long) {
        headerSince = -1
        lastFrame = now
        arriving.begin(now)
    }

    override fun arrived(frame: Frame, now: Long) {
        whole(now)
        if (pace.inflated(decoder.takeSurplus(), now)) server.counting.add(ServerCount.CONNECTIONS_PACED)
        val id = frame.id
        when (val meaning = session.receive(id, null, now)) {
            is Incoming.Answer -> {
                queuedBytes -= meaning.token.body.length
                acknowledged(meaning.token, frame.body)
            }
            Incoming.Late -> unusable()
            Incoming.Command -> handle(id, frame.body, now)
            // Robots take no reports, and streams have a port of their own.
            Incoming.Report, Incoming.Repeated, Incoming.Stream -> {
                unusable()
                refuse(id, protocol.results.protocol)
            }
        }
    }

    /** A frame has made work for nothing: after too many of these the connection rests. */
    private fun unusable() {
        if (!pace.unusable(loop.now)) return
        server.counting.add(ServerCount.CONNECTIONS_PACED)
        server.lines.say(LogLevel.WARN, "paced") { "makes useless work, and is not read for a while: $id from $address" }
    }

    private fun acknowledged(report: Queued, body: ByteArray) {
        val refusal = try {
            val read = Bodies.enveloped(protocol.responseEnvelope, Empty, body, limits.json())
            Envelopes.refusal(protocol, read.envelope)
        } catch (_: BodyError) {
            server.counting.add(ServerCount.REPORTS_REFUSED)
            return report.ended(AckOutcome.INVALID, null)
        }
        server.counting.add(if (refusal == null) ServerCount.REPORTS_ACKNOWLEDGED else ServerCount.REPORTS_REFUSED)
        report.ended(if (refusal == null) AckOutcome.ACKNOWLEDGED else AckOutcome.REFUSED, refusal)
    }

    // Requests.

    private fun handle(id: FrameId, body: ByteArray, now: Long) {
        val entry = server.service.entries[id.code]
        val raw = server.service.rawHandler(id.code, isKnown = id.code in server.commands)
        val effect = server.commands[id.code]?.effect ?: Effect.UNKNOWN
        when {
            effect !in effects -> {
                server.counting.add(ServerCount.CALLS_FORBIDDEN)
                server.lines.say(LogLevel.WARN, "call forbidden") { "code ${id.code} is not allowed from $address" }
                refuse(id, said(protocol.results.protocol, "not allowed from this address"))
            }
            entry != null -> begin(entry, id, body, now)
            raw != null -> beginRaw(raw, id, body, now)
            id.code in server.commands -> refuse(id, notImplemented())
            else -> {
                unusable()
                refuse(id, protocol.results.protocol)
            }
        }
    }

    private fun notImplemented(): Refusal {
        server.counting.add(ServerCount.CALLS_NOT_IMPLEMENTED)
        return said(protocol.results.protocol, "not implemented")
    }

    private fun unknown() = protocol.results.protocol.let { Refusal(it.code, it.text) }

    private fun said(result: ResultText, why: String) = Refusal(result.code, "${result.text}: $why")

    /** Reads envelope and body in one pass, and looks at the time; `null` if the request has been refused. */
    private fun <Q : Message> read(type: MessageType<Q>, id: FrameId, body: ByteArray): Pair<Q, Context>? {
        val read = try {
            Bodies.enveloped(protocol.requestEnvelope, type, body, limits.json())
        } catch (error: BodyError) {
            unusable()
            refuse(id, said(protocol.results.invalid, checkNotNull(error.message)))
            return null
        }
        val time = Envelopes.time(protocol.requestEnvelope, read.envelope)
        val age = config.maxAge ?: protocol.defaults.maxAge
        val request = read.body
        when {
            age != null && time != null && System.currentTimeMillis() - time > age -> {
                unusable()
                refuse(id, protocol.results.expired)
            }
            request == null -> {
                unusable()
                refuse(id, said(protocol.results.invalid, "${read.fault?.message}"))
            }
            else -> return request to Context(address, this.id, id.id, id.code, time, ::notImplemented, unknown())
        }
        return null
    }

    private fun <Q : Message, A : Message> begin(entry: Service.Entry<Q, A>, id: FrameId, body: ByteArray, now: Long) {
        val (request, context) = read(entry.command.request, id, body) ?: return
        launch(id, context, entry.command.effect, now) {
            val response = entry.handler.handle(context, request)
            response.check()
            val success = protocol.results.success
            encoded(response, success.code, success.text)
        }
    }

    private fun beginRaw(handler: RawHandler, id: FrameId, body: ByteArray, now: Long) {
        val (_, context) = read(Keys, id, body) ?: return
        val text = Json.trusted(if (body.isEmpty()) "{}" else Bodies.utf8(body))
        val effect = server.commands[id.code]?.effect ?: Effect.UNKNOWN
        launch(id, context, effect, now) {
            val answer = handler.handle(context, RawRequest(id.code, text))
            server.encoder.prepare(completed(answer))
        }
    }

    /** An answer made elsewhere: the envelope of success supplies the keys of the envelope that it lacks. */
    private fun completed(answer: Json): ByteArray {
        val keys = Bodies.decode(Keys, answer.text.toByteArray(), limits.json())
        val success = protocol.results.success
        val envelope = Envelopes.response(protocol, System.currentTimeMillis(), success.code, success.text)
        val type = envelope.messageType
        val values = Array(type.fields.size) { index ->
            envelope.values[index].takeIf { keys.extra[type.fields[index].key] == null }
        }
        val whole = Bodies.write(type.make(values, Extra.NONE), keys)
        Bodies.enveloped(protocol.responseEnvelope, Empty, whole, limits.json())
        return whole
    }

    /** Has a handler at work until its deadline. */
    private fun launch(id: FrameId, context: Context, effect: Effect, now: Long, answer: suspend () -> Prepared) {
        if (outlives(effect) && server.isAbandonedFull) {
            server.counting.add(ServerCount.ABANDONED_REACHED)
            return refuse(id, said(protocol.results.protocol, "too many handlers are still at work"))
        }
        val job = server.scope.launch(start = CoroutineStart.LAZY) { run(id, context, answer) }
        val work = Work(job, context, effect)
        // A peer that uses an id twice at once gets two answers, and is not told apart.
        working.put(id, work)?.let { abandon(it) }
        work.deadline = loop.schedule(after(now, config.handlerTimeout ?: protocol.defaults.handlerTimeout)) { late(id, work) }
        job.start()
    }

    private fun outlives(effect: Effect) = effect == Effect.MOTION || effect == Effect.UNKNOWN

    private suspend fun run(id: FrameId, context: Context, answer: suspend () -> Prepared) {
        val made = try {
            answer()
        } catch (refusal: Refusal) {
            return loop.execute { done(id, context) { refuse(id, refusal) } }
        } catch (cancelled: CancellationException) {
            loop.execute { done(id, context) { failed(id) } }
            throw cancelled
        } catch (_: Throwable) {
            // Whatever it is, it harms this call alone.
            return loop.execute { done(id, context) { failed(id) } }
        }
        loop.execute {
            done(id, context) {
                server.counting.add(ServerCount.CALLS_ANSWERED)
                send(made.frame(id.answer()))
            }
        }
    }

    private fun failed(id: FrameId) {
        server.counting.add(ServerCount.HANDLERS_PANICKED)
        refuse(id, said(protocol.results.protocol, "the handler failed"))
    }

    private fun encoded(response: Message, code: Long, text: String): Prepared =
        server.encoder.prepare(Bodies.write(Envelopes.response(protocol, System.currentTimeMillis(), code, text), response))

    /** A handler has ended; [answer] unless nobody waits for it any more. */
    private inline fun done(id: FrameId, context: Context, answer: () -> Unit) {
        val work = working[id] ?: return
        if (work.context !== context) return
        working.remove(id)
        work.deadline?.cancel()
        answer()
        wake()
    }

    private fun late(id: FrameId, work: Work) {
        working.remove(id)
        server.counting.add(ServerCount.CALLS_TIMED_OUT)
        refuse(id, protocol.results.timeout)
        abandon(work)
        wake()
    }

    private fun abandon(work: Work) {
        work.deadline?.cancel()
        server.abandon(work.job, work.effect)
        work.context.gone.complete(Unit)
    }

    private fun refuse(id: FrameId, result: ResultText) = refuse(id, Refusal(result.code, result.text))

    private fun refuse(id: FrameId, refusal: Refusal) {
        server.counting.add(ServerCount.CALLS_REFUSED)
        if (!Envelopes.hasResult(protocol)) return
        val body = try {
            encoded(Empty.INSTANCE, refusal.code, refusal.text)
        } catch (_: FrameError) {
            return
        }
        send(body.frame(id.answer()))
    }

    // Reports.

    /** Queues a report. If the queue is full, the oldest in it give way. */
    fun push(report: Queued) {
        while (queue.size >= limits.queuedReports || queuedBytes + report.body.length > mostQueuedBytes) {
            val oldest = queue.removeFirstOrNull() ?: return drop(report)
            queuedBytes -= oldest.body.length
            drop(oldest)
        }
        queue.addLast(report)
        queuedBytes += report.body.length
        wake()
    }

    private fun drop(report: Queued) {
        server.counting.add(ServerCount.REPORTS_DROPPED)
        report.ended(AckOutcome.DROPPED, null)
    }

    /** Repetitions to different apps are spread over an eighth of the wait. */
    private fun spread(policy: AckPolicy) =
        AckPolicy(policy.timeout + policy.timeout / 8 / PLACES * (id % PLACES), policy.retries)

    override fun tend(now: Long): Long {
        while (true) {
            val due = session.due(now) ?: break
            if (due is Due.Again) {
                if (unsent >= HIGH_WATER) continue
                server.counting.add(ServerCount.REPORTS_REPEATED)
                send(due.token.body.frame(due.frame))
            } else {
                server.counting.add(ServerCount.REPORTS_TIMED_OUT)
                queuedBytes -= due.token.body.length
                due.token.ended(AckOutcome.TIMED_OUT, null)
            }
        }
        while (!isDeaf && unsent < HIGH_WATER && session.inFlight < limits.inFlight) {
            val report = queue.removeFirstOrNull() ?: break
            val frame = session.open(protocol.reportKind, report.code, spread(report.policy), now, report) ?: break
            send(report.body.frame(frame))
        }
        val due = watch(now)
        if (due <= now && isOver) return due
        if ((isDraining || isDeaf) && working.isEmpty() && unsent == 0L) goPolitely()
        val rested = if (pace.until > now) pace.until else Long.MAX_VALUE
        return minOf(minOf(due, rested), session.nextDue() ?: Long.MAX_VALUE)
    }

    /** What does not come, or go, in time. */
    private fun watch(now: Long): Long {
        val isReading = reads()
        if (isReading && !wasReading) arriving.begin(now)
        wasReading = isReading
        headerSince = if (!decoder.isInsideHeader) -1 else if (headerSince < 0) now else headerSince
        val header = if (headerSince >= 0 && isReading) after(headerSince, config.headerTimeout) else Long.MAX_VALUE
        val stalls = if (isReading && decoder.pending > 0) arriving.deadline else Long.MAX_VALUE
        val unread = if (unsent > 0) leaving.deadline else Long.MAX_VALUE
        val idleLimit = config.idleTimeout
        val isIdle = working.isEmpty() && decoder.pending == 0
        val idle = if (idleLimit != null && isIdle) after(lastFrame, idleLimit) else Long.MAX_VALUE
        if (header <= now || stalls <= now) {
            server.counting.add(ServerCount.CONNECTIONS_TIMED_OUT)
            // Requests before it may still be carried out.
            isDeaf = true
            return Long.MAX_VALUE
        }
        if (unread <= now || idle <= now) {
            server.counting.add(ServerCount.CONNECTIONS_TIMED_OUT)
            if (unread <= now) goAtOnce() else goPolitely()
            return now
        }
        return minOf(minOf(header, stalls), minOf(unread, idle))
    }

    // The end.

    /** Reads no more requests, and ends once everything is answered. */
    fun drain() {
        isDraining = true
        wake()
    }

    private fun goAtOnce() {
        cut()
        server.leave(this)
    }

    private fun goPolitely() {
        server.parts()
        isParting = true
        part()
        server.leave(this)
    }

    private var isParting = false

    override fun gone() {
        if (isParting) server.gone()
    }

    /** Nothing more will be answered. */
    fun left() {
        val reports = session.endIf { true } + queue
        queue.clear()
        reports.forEach { it.ended(AckOutcome.CLOSED, null) }
        val left = working.values.toList()
        working.clear()
        left.forEach { abandon(it) }
    }

    private companion object {
        /** Beyond this much unsent, in bytes, nothing is read or taken up. */
        const val HIGH_WATER = 256 * 1024
        const val PLACES = 32
    }
}
