package fc.runtime

import java.net.SocketAddress
import java.util.concurrent.CancellationException
import kotlinx.coroutines.CoroutineStart
import kotlinx.coroutines.Job
import kotlinx.coroutines.currentCoroutineContext
import kotlinx.coroutines.isActive
import kotlinx.coroutines.launch

/** The command connection of one app to a robot. */
internal class Peer(
    private val server: ServerCore,
    link: Link,
    val id: Long,
    val address: SocketAddress?,
    /** The effects that its address may call. */
    private val effects: Set<Effect>,
) : Conversation(server.loop, link, server.config.decoder(server.protocol)), MemoryHolder {
    /** A request in its handler. */
    private class Work(
        val id: FrameId,
        val context: Context,
        val effect: Effect,
        /** The handler object of the user. */
        val called: Any,
        /** Bytes lent to the handler. */
        val bytes: Long,
    ) {
        /** Time of [System.nanoTime]. */
        val since = System.nanoTime()
        var job: Job? = null
        var deadline: Timer? = null
        var isOver = false
    }

    /** Runs a request and creates the response. */
    private class Task(
        val called: Any,
        val context: Context,
        val effect: Effect,
        val bytes: Long,
        val handle: suspend () -> Any?,
        val respond: (Any?) -> Prepared,
    )

    private val protocol = server.protocol
    private val config = server.config
    private val limits = server.limits
    private val session =
        Session<Queued>(protocol, limits, protocol.defaults.ack, config.firstId ?: idOfNow())
    private val queue = ArrayDeque<Queued>()

    /** Bytes of the reports in the queue and in flight. */
    private var queuedBytes = 0L

    /** Bytes of the reports in flight. */
    private var flyingBytes = 0L
    private val mostQueuedBytes = config.queuedBytes ?: limits.inflatedBytes

    /** In order of start. Several may have the same id. */
    private val working = LinkedHashSet<Work>()

    /** A request that waits for memory. Later requests wait for it. */
    private var waiting: Frame? = null

    /** Bytes to be lent for [waiting]. */
    private var waitingBytes = 0L
    private var isDraining = false

    /** `true` once reading has ended. Completed requests still get their responses. */
    private var isDeaf = false
    private var headerSince = -1L
    private val arriving = RateWatch(config.leastRate, config.stallTimeout)
    private val leaving = RateWatch(config.leastRate, config.stallTimeout)
    private val pace = Pace()
    private var wasReading = true
    private var lastFrame = loop.now

    /** `true` once something has been received. */
    var isHeard = false
        private set

    override fun reads(): Boolean = !isDraining && !isDeaf && waiting == null && working.size < limits.inFlight &&
        unsent < HIGH_WATER && pace.until <= loop.now

    /** Reports in flight and unsent bytes mostly share their arrays. */
    override val held: Long
        get() = decoder.capacity + (waiting?.body?.size ?: 0) + queuedBytes - flyingBytes + maxOf(flyingBytes, unsent)
    override var counted = 0L

    override fun room(bytes: Long): Boolean = server.memory.room(this, bytes)

    override fun settle() {
        if (!isOver) server.memory.settle(this)
    }

    override fun failed(failure: Throwable): Unit = server.lines.failed("a connection failed", failure)

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
                landed(meaning.token)
                acknowledged(meaning.token, frame.body)
            }
            Incoming.Late -> unusable()
            Incoming.Command -> handle(frame, now)
            // Robots take no reports, and streams use the data port.
            Incoming.Report, Incoming.Repeated, Incoming.Stream -> {
                unusable()
                refuse(id, protocol.results.protocol)
            }
        }
    }

    /** Counts a useless frame. After too many, the connection pauses. */
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

    private fun handle(frame: Frame, now: Long, bytes: Long = TEXTS * frame.body.size) {
        val (id, body) = frame.id to frame.body
        val entry = server.service.entries[id.code]
        val raw = server.service.rawHandler(id.code, isKnown = id.code in server.commands)
        val effect = server.commands[id.code]?.effect ?: Effect.UNKNOWN
        when {
            effect !in effects -> {
                server.counting.add(ServerCount.CALLS_FORBIDDEN)
                server.lines.say(LogLevel.WARN, "call forbidden") { "code ${id.code} is not allowed from $address" }
                refuse(id, said(protocol.results.protocol, "not allowed from this address"))
            }
            entry != null || raw != null -> {
                if (!server.memory.lend(this, bytes)) return defer(frame, bytes)
                var task: Task? = null
                try {
                    task = if (entry != null) task(entry, id, body) else task(checkNotNull(raw), id, effect, body)
                } finally {
                    if (task?.bytes != bytes) server.memory.giveBack(bytes)
                }
                task ?: return
                // Short texts may contain long lists.
                if (task.bytes != bytes && !server.memory.lend(this, task.bytes)) return defer(frame, task.bytes)
                launch(id, task, now)
            }
            id.code in server.commands -> refuse(id, notImplemented())
            else -> {
                unusable()
                refuse(id, protocol.results.protocol)
            }
        }
    }

    private fun defer(frame: Frame, bytes: Long) {
        waiting = frame
        waitingBytes = bytes
    }

    private fun notImplemented(): Refusal {
        server.counting.add(ServerCount.CALLS_NOT_IMPLEMENTED)
        return said(protocol.results.protocol, "not implemented")
    }

    private fun unknown() = protocol.results.protocol.let { Refusal(it.code, it.text) }

    private fun said(result: ResultText, why: String) = Refusal(result.code, "${result.text}: $why")

    /** Reads envelope and body in one pass and checks the age. Returns `null` after a refusal. */
    private fun <Q : Message> read(
        type: MessageType<Q>,
        id: FrameId,
        body: ByteArray,
        task: (Q, Context, listBytes: Long) -> Task,
    ): Task? {
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
            else -> {
                val context = Context(address, this.id, id.id, id.code, time, ::notImplemented, unknown()) { failure, action ->
                    loop.execute { server.lines.failed("an action of `onAbandoned` failed", failure, action) }
                }
                return task(request, context, read.listBytes)
            }
        }
        return null
    }

    private fun <Q : Message, A : Message> task(entry: Service.Entry<Q, A>, id: FrameId, body: ByteArray): Task? =
        read(entry.command.request, id, body) { request, context, listBytes ->
            val handle: suspend () -> Any? = { entry.handler.handle(context, request) }
            Task(entry.called, context, entry.command.effect, TEXTS * body.size + listBytes, handle) { response ->
                val success = protocol.results.success
                encoded(entry.command.response.demand(response), success.code, success.text)
            }
        }

    private fun task(entry: Service.RawEntry, id: FrameId, effect: Effect, body: ByteArray): Task? =
        read(Keys, id, body) { _, context, _ ->
            val text = Json.trusted(if (body.isEmpty()) "{}" else Bodies.utf8(body))
            val handle: suspend () -> Any? = { entry.handler.handle(context, RawRequest(id.code, text)) }
            Task(entry.called, context, effect, TEXTS * body.size, handle) { answer ->
                if (answer !is Json) throw BodyError(BodyErrorKind.WRONG_TYPE, "found something else; send a `Json`")
                server.encoder.prepare(completed(answer))
            }
        }

    /** Completes an untyped response with the missing envelope keys of success. */
    private fun completed(answer: Json): ByteArray {
        val keys = Bodies.decode(Keys, answer.text.toByteArray(), limits.json())
        val success = protocol.results.success
        val envelope = Envelopes.response(protocol, System.currentTimeMillis(), success.code, success.text)
        val type = envelope.messageType
        val there = keys.extra.keys
        val values = Array(type.fields.size) { index -> envelope.values[index].takeIf { type.fields[index].key !in there } }
        val whole = Bodies.write(type.make(values, Extra.NONE), keys)
        Bodies.enveloped(protocol.responseEnvelope, Empty, whole, limits.json())
        return whole
    }

    /** Runs a handler until its deadline. */
    private fun launch(id: FrameId, task: Task, now: Long) {
        if (outlives(task.effect) && server.isAbandonedFull) {
            server.counting.add(ServerCount.ABANDONED_REACHED)
            server.memory.giveBack(task.bytes)
            return refuse(id, said(protocol.results.protocol, "too many handlers are still at work"))
        }
        val work = Work(id, task.context, task.effect, task.called, task.bytes)
        val job = server.scope.launch(server.handlerFaults, CoroutineStart.LAZY) { run(work, task) }
        work.job = job
        working.add(work)
        if (working.size == limits.inFlight) server.counting.add(ServerCount.IN_FLIGHT_REACHED)
        // A dispatcher that accepts no more work cancels the job before it starts.
        job.invokeOnCompletion { cause -> if (cause != null) loop.execute { finish(work) { cancelled(work) } } }
        work.deadline = loop.schedule(after(now, config.handlerTimeout ?: protocol.defaults.handlerTimeout)) { late(work) }
        try {
            job.start()
        } catch (failure: Throwable) {
            finish(work, onFailure(work, failure))
        }
    }

    private fun outlives(effect: Effect) = effect == Effect.MOTION || effect == Effect.UNKNOWN

    /** Runs on a thread of the handlers. */
    private suspend fun run(work: Work, task: Task) {
        val end = try {
            onResponse(work, task.respond, task.handle())
        } catch (refusal: Refusal) {
            onRefusal(work, refusal)
        } catch (failure: Throwable) {
            val isOurs = failure is CancellationException && !currentCoroutineContext().isActive
            if (isOurs) ({ cancelled(work) }) else onFailure(work, failure)
        }
        loop.execute { finish(work, end) }
    }

    private fun onRefusal(work: Work, refusal: Refusal): () -> Unit = when {
        refusal.code == protocol.results.success.code -> onFailure(work, refusal)
        !Envelopes.carries(protocol, refusal.code) -> {
            onInvalid(work, BodyError(BodyErrorKind.OUT_OF_RANGE, "the result code ${refusal.code} is no value of its field"))
        }
        else -> ({ refuse(work.id, refusal, work.since) })
    }

    private fun onResponse(work: Work, respond: (Any?) -> Prepared, response: Any?): () -> Unit {
        val body = try {
            respond(response)
        } catch (error: BodyError) {
            return onInvalid(work, error)
        } catch (error: FrameError) {
            return onInvalid(work, error)
        }
        return {
            server.counting.add(ServerCount.CALLS_SUCCEEDED)
            send(body, work.id.answer())
            server.callEnded(work.id.code, "success", work.since)
        }
    }

    /** Handles a response that breaks the spec. */
    private fun onInvalid(work: Work, error: Exception): () -> Unit {
        server.handlerFailed(error, work.context, work.called) { "the response to $it breaks the spec" }
        return { refuse(work, protocol.results.protocol) }
    }

    /** Handles a failed handler, which affects only this call. */
    private fun onFailure(work: Work, failure: Throwable): () -> Unit {
        server.counting.add(ServerCount.HANDLERS_PANICKED)
        server.handlerFailed(failure, work.context, work.called) { "the handler of $it failed" }
        return { refuse(work.id, said(protocol.results.protocol, "the handler failed"), work.since) }
    }

    private fun cancelled(work: Work) =
        refuse(work.id, said(protocol.results.protocol, "the handler was cancelled"), work.since)

    private fun encoded(response: Message, code: Long, text: String): Prepared =
        server.encoder.prepare(Bodies.write(Envelopes.response(protocol, System.currentTimeMillis(), code, text), response))

    /** Ends a handler and calls [answer], unless the app has stopped waiting. */
    private inline fun finish(work: Work, answer: () -> Unit) {
        if (work.isOver) return
        work.isOver = true
        server.memory.giveBack(work.bytes)
        if (!working.remove(work)) return
        work.deadline?.cancel()
        answer()
        wake()
    }

    private fun late(work: Work) {
        working.remove(work)
        refuse(work, protocol.results.timeout)
        abandon(work)
        wake()
    }

    private fun abandon(work: Work) {
        work.deadline?.cancel()
        server.abandon(checkNotNull(work.job), work.effect)
        work.context.gone.complete(Unit)
    }

    private fun refuse(id: FrameId, result: ResultText) = refuse(id, Refusal(result.code, result.text))

    private fun refuse(work: Work, result: ResultText) = refuse(work.id, Refusal(result.code, result.text), work.since)

    /** Responds with a refusal. The request began at [since]. */
    private fun refuse(id: FrameId, refusal: Refusal, since: Long = System.nanoTime()) {
        val counter = counterOf(refusal.code)
        server.counting.add(counter)
        server.callEnded(id.code, nameOf(counter), since)
        if (!Envelopes.hasResult(protocol)) return
        val body = refused(refusal.code, refusal.text) ?: protocol.results.protocol.run { refused(code, text) }
        if (body != null) send(body, id.answer())
    }

    private fun counterOf(result: Long): ServerCount = when (result) {
        protocol.results.protocol.code -> ServerCount.CALLS_PROTOCOL
        protocol.results.timeout.code -> ServerCount.CALLS_TIMED_OUT
        protocol.results.invalid.code -> ServerCount.CALLS_INVALID
        protocol.results.expired.code -> ServerCount.CALLS_EXPIRED
        else -> ServerCount.CALLS_REFUSED
    }

    private fun nameOf(counter: ServerCount): String = when (counter) {
        ServerCount.CALLS_PROTOCOL -> "protocol"
        ServerCount.CALLS_TIMED_OUT -> "timeout"
        ServerCount.CALLS_INVALID -> "invalid"
        ServerCount.CALLS_EXPIRED -> "expired"
        else -> "refused"
    }

    /** Encodes a refusal. Returns `null` if its text does not fit into a frame. */
    private fun refused(code: Long, text: String): Prepared? = try {
        encoded(Empty.INSTANCE, code, text)
    } catch (error: FrameError) {
        server.lines.failed("no frame is long enough for a refusal", error)
        null
    }

    // Reports.

    /** Queues a report. If the queue is full, the oldest reports are dropped. */
    fun push(report: Queued) {
        // Queued reports close no connection.
        while (queue.size >= limits.queuedReports || !hasPlace(report.body.length)) {
            val oldest = queue.removeFirstOrNull() ?: return drop(report)
            queuedBytes -= oldest.body.length
            settle()
            drop(oldest)
        }
        queue.addLast(report)
        queuedBytes += report.body.length
        settle()
        wake()
    }

    /** Removes a report in flight. */
    private fun landed(report: Queued) {
        queuedBytes -= report.body.length
        flyingBytes -= report.body.length
    }

    private fun hasPlace(bytes: Int): Boolean = queuedBytes + bytes <= mostQueuedBytes && server.memory.hasRoom(bytes.toLong())

    /** Handles a request that waited for memory, if there is enough now. */
    private fun resume(now: Long) {
        val frame = waiting ?: return
        waiting = null
        handle(frame, now, waitingBytes)
        if (waiting == null) wake()
    }

    private fun drop(report: Queued) {
        server.counting.add(ServerCount.REPORTS_DROPPED)
        report.ended(AckOutcome.DROPPED, null)
    }

    /** Spreads the repetitions to different apps over an eighth of the wait. */
    private fun spread(policy: AckPolicy) =
        AckPolicy(minOf(policy.timeout + policy.timeout / 8 / PLACES * (id % PLACES), Settings.LONGEST), policy.retries)

    override fun tend(now: Long): Long {
        resume(now)
        if (isOver) return Long.MAX_VALUE
        while (true) {
            val due = session.due(now) ?: break
            if (due is Due.Again) {
                if (unsent >= HIGH_WATER) continue
                server.counting.add(ServerCount.REPORTS_REPEATED)
                send(due.token.body, due.frame)
            } else {
                server.counting.add(ServerCount.REPORTS_TIMED_OUT)
                landed(due.token)
                due.token.ended(AckOutcome.TIMED_OUT, null)
            }
        }
        while (!isDeaf && unsent < HIGH_WATER && session.inFlight < limits.inFlight) {
            val report = queue.removeFirstOrNull() ?: break
            val frame = session.open(protocol.reportKind, report.code, spread(report.policy), now, report) ?: break
            flyingBytes += report.body.length
            server.counting.add(ServerCount.REPORTS_SENT)
            send(report.body, frame)
        }
        if (isOver) return Long.MAX_VALUE
        val due = watch(now)
        if (due <= now && isOver) return due
        if ((isDraining || isDeaf) && working.isEmpty() && waiting == null && unsent == 0L) goPolitely()
        val rested = if (pace.until > now) pace.until else Long.MAX_VALUE
        return minOf(minOf(due, rested), session.nextDue() ?: Long.MAX_VALUE)
    }

    /** Detects a connection without progress. Returns the next deadline. */
    private fun watch(now: Long): Long {
        val isReading = reads() && !isStarved
        if (isReading && !wasReading) arriving.begin(now)
        wasReading = isReading
        headerSince = if (!decoder.isInsideHeader) -1 else if (headerSince < 0) now else headerSince
        val header = if (headerSince >= 0 && isReading) after(headerSince, config.headerTimeout) else Long.MAX_VALUE
        val stalls = if (isReading && decoder.pending > 0) arriving.deadline else Long.MAX_VALUE
        val unread = if (unsent > 0) leaving.deadline else Long.MAX_VALUE
        val idleLimit = config.idleTimeout
        val isIdle = working.isEmpty() && waiting == null && decoder.pending == 0
        val idle = if (idleLimit != null && isIdle) after(lastFrame, idleLimit) else Long.MAX_VALUE
        if (header <= now || stalls <= now) {
            server.counting.add(ServerCount.CONNECTIONS_TIMED_OUT)
            // Earlier requests may still complete.
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

    /** Reads no more requests, and ends after all responses. */
    fun drain() {
        isDraining = true
        wake()
    }

    private fun goAtOnce() {
        cut()
        server.leave(this)
    }

    private fun goPolitely() {
        if (isOver) return
        server.parts()
        isParting = true
        part()
        server.leave(this)
    }

    private var isParting = false

    override fun gone() {
        if (isParting) server.gone() else server.leave(this)
    }

    /** Cleans up: no more responses are sent. */
    fun left() {
        val reports = session.endIf { true } + queue
        queue.clear()
        waiting = null
        reports.forEach { it.ended(AckOutcome.CLOSED, null) }
        val left = working.toList()
        working.clear()
        left.forEach { abandon(it) }
    }

    private companion object {
        /** Limit of unsent bytes above which the robot reads and starts no more requests. */
        const val HIGH_WATER = 256 * 1024
        const val PLACES = 32

        /** Memory of a request per byte of its text, which may be Chinese. */
        const val TEXTS = 2L
    }
}
