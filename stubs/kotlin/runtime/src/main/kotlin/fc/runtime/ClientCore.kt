package fc.runtime

import java.io.IOException

/** A call in flight. */
internal class CallInFlight(
    val code: Int,
    val timeout: Long,
    /** `true` if the call may be sent once more after a loss. */
    var repeats: Boolean,
    val body: Prepared,
    /** Called once with the body of the response, or the error. */
    val done: (ByteArray?, CallError?) -> Unit,
) {
    var frame: FrameId? = null
    var progress = Progress.UNSENT

    enum class Progress {
        UNSENT,
        SENT,

        /** In flight when the connection was lost, to be sent once more. */
        AGAIN,
    }

    val isToSend: Boolean get() = progress != Progress.SENT
}

/** A client without threads and sockets. It runs on its loop alone. */
internal class ClientCore(val protocol: Protocol, val config: ClientConfig, val loop: Loop, private val dial: Dial) {
    private val lines = Lines(config.log, protocol) { loop.now }
    val life: Life = Life { tell(it) }
    val limits: Limits = config.limitsOr(protocol)
    val queues = Queues(limits.queuedReports, config.queuedBytes ?: limits.inflatedBytes)
    val counting = Counting<ClientCount>(ClientCount.entries.size)
    val encoder: Encoder = config.encoder(protocol)
    private val session = Session<CallInFlight>(protocol, limits, protocol.defaults.ack, config.firstId ?: idOfNow())
    private val reports = protocol.reports.associateBy { it.code }
    private val tries = Tries(config.reconnect)
    private val beats = Beats(protocol)

    /** Data connections, which follow this connection. */
    val dependents = ArrayList<DataCore>()
    private var line: Line? = null
    private var attempt: Timer? = null
    private var timer: Timer? = null
    private var armed = Long.MAX_VALUE

    /** Called when no connection is left, not even a closing one. */
    var onEnd: () -> Unit = {}

    @Volatile
    var inFlight = 0
        private set

    /** `true` if a failure of the first attempt is final. */
    private var isFirstOnly = false

    /** Starts to connect. With [isFirstOnly], a failure of the first attempt is final. */
    fun begin(isFirstOnly: Boolean) = loop.execute {
        this.isFirstOnly = isFirstOnly
        connect()
    }

    /** Logs an exception of a listener. For any thread. */
    fun listenerFailed(what: String, failure: Throwable, listener: Any): Unit =
        loop.execute { lines.failed("$what failed", failure, listener) }

    /** Sends a call, or queues it until there is a connection. */
    fun start(call: CallInFlight) {
        val now = life.now
        if (now is ConnectionState.Closed) return call.done(null, CallError(CallErrorKind.CLOSED, now.why))
        val frame = session.open(protocol.commandKind, call.code, AckPolicy(call.timeout, 0), loop.now, call)
            ?: return call.done(null, CallError(CallErrorKind.BUSY))
        call.frame = frame
        inFlight = session.inFlight
        if (now.isConnected) send(call)
        arm()
    }

    /** Cancels a call. */
    fun cancel(call: CallInFlight) {
        call.frame?.let { session.cancel(it) }
        inFlight = session.inFlight
    }

    fun close() {
        if (life.now.isClosed) return
        val line = line
        this.line = null
        down(Loss.HERE, isForGood = true)
        if (line != null) line.part() else onEnd()
    }

    private fun send(call: CallInFlight) {
        val frame = checkNotNull(call.frame)
        // A call is repeated at most once, after the first loss.
        call.repeats = call.repeats && call.progress == CallInFlight.Progress.UNSENT
        call.progress = CallInFlight.Progress.SENT
        checkNotNull(line).send(call.body, frame)
    }

    private fun end(call: CallInFlight, body: ByteArray?, error: CallError?) {
        inFlight = session.inFlight
        call.done(body, error)
    }

    // Connecting.

    private fun connect() {
        val wait = tries.next()
        val why = life.now.why ?: Loss.NOT_YET
        if (wait == null) {
            down(why, isForGood = true)
            return onEnd()
        }
        attempt = loop.schedule(after(loop.now, wait)) { dialNow() }
    }

    private fun dialNow() {
        var isDone = false
        var limit: Timer? = null
        val dialling = dial.dial { link, failure ->
            isDone = true
            limit?.cancel()
            if (link != null) up(link) else failed(Loss.unreachable(failure ?: IOException("no connection")))
        }
        if (isDone) return
        limit = loop.schedule(after(loop.now, config.connectTimeout)) {
            dialling.cancel()
            failed(Loss.CONNECT_TIMEOUT)
        }
        attempt = object : Timer {
            override fun cancel() {
                limit.cancel()
                dialling.cancel()
            }
        }
    }

    private fun failed(why: Loss) {
        if (life.now.isClosed) return
        tries.failed()
        down(why, isForGood = isFirstOnly)
        if (isFirstOnly) onEnd() else connect()
    }

    private fun up(link: Link) {
        if (life.now.isClosed) return link.close()
        isFirstOnly = false
        val line = Line(link)
        this.line = line
        session.reconnected()
        beats.begin()
        life.connected()
        queues.connected()
        line.start()
        for (call in waiting()) if (line === this.line) send(call)
        for (data in dependents.toList()) data.commandsUp()
    }

    /** Returns the calls that wait for a connection, in the order of the calls. */
    private fun waiting(): List<CallInFlight> {
        val found = ArrayList<CallInFlight>()
        session.endIf {
            if (it.isToSend) found.add(it)
            false
        }
        return found.sortedBy { it.frame?.id }
    }

    /** Ends the calls that must not be sent twice. Keeps the others for the next connection. */
    private fun down(why: Loss, isForGood: Boolean) {
        val wasConnected = life.now.isConnected
        if (isForGood) {
            attempt?.cancel()
            timer?.cancel()
            life.close(why)
            queues.end(why)
            for (data in dependents.toList()) data.end(why)
        } else {
            life.lost(why)
            if (wasConnected) queues.lost(why)
        }
        val ended = session.endIf { call ->
            if (call.repeats && call.progress == CallInFlight.Progress.SENT) call.progress = CallInFlight.Progress.AGAIN
            isForGood || !call.isToSend
        }
        for (call in ended) {
            val isUnsent = call.progress == CallInFlight.Progress.UNSENT
            end(call, null, CallError(if (isUnsent) CallErrorKind.CLOSED else CallErrorKind.LOST, why))
        }
    }

    // Deadlines.

    private fun arm() {
        val due = session.nextDue() ?: Long.MAX_VALUE
        if (due >= armed) return
        timer?.cancel()
        armed = due
        timer = loop.schedule(due) {
            armed = Long.MAX_VALUE
            expire()
            if (!life.now.isClosed) arm()
        }
    }

    private fun expire() {
        while (true) {
            val call = (session.due(loop.now) ?: return).token
            counting.add(ClientCount.TIMEOUTS)
            val now = life.now
            val kind = when {
                now.isConnected -> CallErrorKind.TIMEOUT
                call.progress != CallInFlight.Progress.UNSENT -> CallErrorKind.LOST
                else -> CallErrorKind.NOT_CONNECTED
            }
            end(call, null, CallError(kind, now.why))
        }
    }

    /** One connection. */
    private inner class Line(link: Link) : Conversation(loop, link, config.decoder(protocol)) {
        private val stall = FrameWatch(config.stallTimeout)
        private var unreadSince = 0L

        /** `true` once a frame has arrived. */
        private var isHeard = false

        override fun reads() = true

        override fun came(bytes: Int, isFirst: Boolean, now: Long) {
            counting.add(ClientCount.BYTES_IN, bytes.toLong())
            stall.came(now)
        }

        override fun sent(bytes: Int): Unit = counting.add(ClientCount.BYTES_OUT, bytes.toLong())

        override fun failed(failure: Throwable): Unit = lines.failed("the connection failed", failure)

        override fun begins(now: Long) {
            unreadSince = now
        }

        override fun wrote(bytes: Int, now: Long) {
            unreadSince = now
        }

        override fun tend(now: Long): Long {
            var due = Long.MAX_VALUE
            if (unsent > 0) {
                due = after(unreadSince, config.stallTimeout)
                if (due <= now) {
                    lose(Loss.UNREAD)
                    return due
                }
            }
            val stalls = stall.deadline(decoder.pending, now)
            if (stalls <= now) lose(Loss.stalled(decoder.pending, decoder.expected))
            return minOf(due, stalls)
        }

        override fun ended(end: End) {
            lose(
                when (end) {
                    // Closing a socket with an unread request resets it.
                    is End.Broken -> if (isHeard || end.isOwn) Loss.broken(end.cause) else Loss.UNHEARD
                    is End.Deaf -> end.error?.let {
                        counting.add(ClientCount.BAD_FRAMES)
                        Loss.frame(it)
                    } ?: if (isHeard) Loss.CLOSED else Loss.UNHEARD
                },
            )
        }

        private fun lose(why: Loss) {
            line = null
            cut()
            tries.connected(isHeard)
            down(why, isForGood = false)
            connect()
        }

        override fun gone() {
            if (life.now.isClosed) onEnd()
        }

        override fun skipped(error: FrameError, now: Long) {
            isHeard = true
            stall.whole()
            counting.add(ClientCount.BAD_FRAMES)
            val id = error.frame ?: return
            if (!id.isResponse) return answer(id, protocol.results.protocol.code, protocol.results.protocol.text)
            val meaning = session.receive(id, null, now)
            if (meaning is Incoming.Answer) {
                counting.add(ClientCount.ANSWERS)
                end(meaning.token, null, CallError(CallErrorKind.FRAME, cause = error))
            }
        }

        override fun arrived(frame: Frame, now: Long) {
            isHeard = true
            stall.whole()
            val id = frame.id
            if (!id.isResponse && id.kind == protocol.reportKind) return report(frame, now)
            when (val meaning = session.receive(id, null, now)) {
                is Incoming.Answer -> {
                    counting.add(ClientCount.ANSWERS)
                    end(meaning.token, frame.body, null)
                }
                Incoming.Late -> counting.add(ClientCount.LATE_ANSWERS)
                // Apps handle no commands, and streams use the data port.
                else -> answer(id, protocol.results.protocol.code, protocol.results.protocol.text)
            }
        }

        private fun report(frame: Frame, now: Long) {
            val id = frame.id
            val message = try {
                read(frame)
            } catch (error: BodyError) {
                counting.add(ClientCount.REPORTS_INVALID)
                val invalid = protocol.results.invalid
                return answer(id, invalid.code, "${invalid.text}: ${error.message}")
            }
            val algorithm = protocol.header.algorithm
            val digest = if (algorithm == DigestAlgorithm.MD5) {
                frame.digest
            } else {
                DigestAlgorithm.MD5.digest(frame.body, 0, frame.body.size)
            }
            if (session.receive(id, digest, now) == Incoming.Repeated) {
                counting.add(ClientCount.REPEATED_REPORTS)
                return answer(id, protocol.results.success.code, protocol.results.success.text)
            }
            if (beats.isLate(id.code, now)) counting.add(ClientCount.REPORTS_LATE)
            // A robot that does not read must not make the app collect acknowledgements.
            val missed = if (unsent >= ACKNOWLEDGE_UP_TO) -1 else queues.push(ReceivedReport(id.code, id.id, message, frame.body))
            if (missed < 0) return counting.add(ClientCount.REPORTS_REFUSED)
            counting.add(ClientCount.REPORTS)
            counting.add(ClientCount.REPORTS_MISSED, missed.toLong())
            session.handedOn(id, digest, now)
            answer(id, protocol.results.success.code, protocol.results.success.text)
        }

        /** Reads a report. An unreadable report is refused instead of acknowledged. */
        private fun read(frame: Frame): Message? {
            val type = reports[frame.id.code]?.message
            val read = Bodies.enveloped(protocol.requestEnvelope, type ?: Empty, frame.body, limits.json())
            read.fault?.let { throw it }
            return if (type == null) null else read.body
        }

        /** Sends a response with a result alone. Sends nothing if responses cannot carry the result. */
        private fun answer(id: FrameId, code: Long, text: String) {
            val canSay = code == protocol.results.success.code || Envelopes.hasResult(protocol)
            if (!canSay || unsent >= ACKNOWLEDGE_UP_TO) return
            val envelope = Envelopes.response(protocol, System.currentTimeMillis(), code, text)
            // An envelope alone fits into any reasonable frame limit. Otherwise the robot repeats the request.
            val body = try {
                encoder.prepare(Bodies.write(envelope, Empty.INSTANCE))
            } catch (_: FrameError) {
                return
            }
            send(body, id.answer())
        }
    }

    /** Logs a change of the state. */
    private fun tell(state: ConnectionState) {
        val robot = config.host ?: protocol.host
        when (state) {
            is ConnectionState.Connected ->
                lines.say(LogLevel.INFO, "connected") { "connected to $robot${if (state.connects > 1) " again" else ""}" }
            is ConnectionState.Connecting -> lines.say(LogLevel.WARN, state.why.name) { "no connection to $robot: ${state.why}" }
            is ConnectionState.Closed -> lines.say(LogLevel.INFO, "closed") { "the connection to $robot has ended: ${state.why}" }
        }
    }

    private companion object {
        const val ACKNOWLEDGE_UP_TO = 256 * 1024
    }
}

/** The recent connection attempts. */
internal class Tries(private val backoff: Backoff?) {
    /** `true` before the first attempt, which needs no wait. */
    private var isFirst = true

    /** Consecutive failed attempts. */
    private var failed = 0

    /** Waits since the robot was last heard. */
    private var waits = 0

    fun failed() {
        failed++
    }

    /** Notes the end of a connection. The wait grows for a robot that only accepts and closes. */
    fun connected(isHeard: Boolean) {
        isFirst = false
        failed = 0
        if (isHeard) waits = 0
    }

    /** Returns the wait before the next attempt, or `null` to give up. */
    fun next(): Long? {
        if (isFirst) {
            isFirst = false
            return 0
        }
        val backoff = backoff ?: return null
        if (failed >= backoff.attempts) return null
        val doubled = backoff.first.toDouble() * (1L shl minOf(waits, 20))
        waits++
        return (minOf(doubled, backoff.longest.toDouble()) * (1 - Math.random() / 4)).toLong()
    }
}

/** Detects a stalled frame. The rate limit keeps a wrong length from passing for progress. */
internal class FrameWatch(private val limit: Long) {
    private var begun = -1L
    private var last = 0L

    fun whole() {
        begun = -1
    }

    fun came(now: Long) {
        last = now
    }

    /** Returns the time when the frame stalls after `received` bytes. Between frames, that is never. */
    fun deadline(received: Int, now: Long): Long {
        if (received == 0) {
            begun = -1
            return Long.MAX_VALUE
        }
        if (begun < 0) {
            begun = now
            last = now
        }
        return minOf(after(last, limit), after(begun, limit + received * 1000L / LEAST))
    }

    private companion object {
        /** Least rate of a frame after the stall timeout, in bytes per second. */
        const val LEAST = 16 * 1024
    }
}

/** Detects late periodic reports. */
internal class Beats(protocol: Protocol) {
    private val intervals =
        protocol.reports.mapNotNull { report -> (report.cadence as? Cadence.Every)?.let { report.code to it.milliseconds } }.toMap()
    private val last = HashMap<Int, Long>()

    /** Starts a connection and forgets the reports of the previous one. */
    fun begin() = last.clear()

    /** Notes a new report. Returns `true` if it is too long after the previous one. */
    fun isLate(code: Int, now: Long): Boolean {
        val every = intervals[code] ?: return false
        val before = last.put(code, now) ?: return false
        return now - before > every + every / 2
    }
}
