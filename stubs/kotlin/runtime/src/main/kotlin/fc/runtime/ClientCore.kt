package fc.runtime

import java.io.IOException

/** A call on its way. */
internal class CallInFlight(
    val code: Int,
    val timeout: Long,
    /** Whether it may be sent once more after the connection was lost. */
    var repeats: Boolean,
    val body: Prepared,
    /** Told once how it ended: the body of the answer, or the error. */
    val done: (ByteArray?, CallError?) -> Unit,
) {
    var frame: FrameId? = null
    var progress = Progress.UNSENT

    enum class Progress {
        UNSENT,
        SENT,

        /** Was on its way when the connection was lost, and may be sent once more. */
        AGAIN,
    }

    val isToSend: Boolean get() = progress != Progress.SENT
}

/** A client without threads and sockets: all of it happens on its loop. */
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

    /** Data connections, which are made again with this one and end with it. */
    val dependents = ArrayList<DataCore>()
    private var line: Line? = null
    private var attempt: Timer? = null
    private var timer: Timer? = null
    private var armed = Long.MAX_VALUE

    /** Told when there is no connection any more, not even one that says goodbye. */
    var onEnd: () -> Unit = {}

    @Volatile
    var inFlight = 0
        private set

    /** If the first attempt fails, it is the only one. */
    private var isFirstOnly = false

    /** Begins to connect; with [isFirstOnly], a first attempt that fails is the end. */
    fun begin(isFirstOnly: Boolean) = loop.execute {
        this.isFirstOnly = isFirstOnly
        connect()
    }

    /** Logs an exception of a listener. From any thread. */
    fun listenerFailed(what: String, failure: Throwable, listener: Any): Unit =
        loop.execute { lines.failed("$what failed", failure, listener) }

    /** Sends a call, or has it wait for a connection. */
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

    /** Nobody waits for a call any more. */
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
        // Once more, and not as often as the connection is lost.
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

    /** The calls that wait for a connection, in the order in which they were made. */
    private fun waiting(): List<CallInFlight> {
        val found = ArrayList<CallInFlight>()
        session.endIf {
            if (it.isToSend) found.add(it)
            false
        }
        return found.sortedBy { it.frame?.id }
    }

    /** Ends the calls that must not be sent twice, and keeps the others for the next connection. */
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

    // What is due.

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

        /** It gave at least one frame. */
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
                    // A socket that is closed while a request lies unread in it is reset.
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
                // Apps serve no commands, and streams have a port of their own.
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
            // A robot that does not read must not make the app collect acknowledgements for it.
            val missed = if (unsent >= ACKNOWLEDGE_UP_TO) -1 else queues.push(ReceivedReport(id.code, id.id, message, frame.body))
            if (missed < 0) return counting.add(ClientCount.REPORTS_REFUSED)
            counting.add(ClientCount.REPORTS)
            counting.add(ClientCount.REPORTS_MISSED, missed.toLong())
            session.handedOn(id, digest, now)
            answer(id, protocol.results.success.code, protocol.results.success.text)
        }

        /** What the app could not read is refused here, and not acknowledged to be found out later. */
        private fun read(frame: Frame): Message? {
            val type = reports[frame.id.code]?.message
            val read = Bodies.enveloped(protocol.requestEnvelope, type ?: Empty, frame.body, limits.json())
            read.fault?.let { throw it }
            return if (type == null) null else read.body
        }

        /** Replies with nothing but a result; not at all where no response can carry it. */
        private fun answer(id: FrameId, code: Long, text: String) {
            val canSay = code == protocol.results.success.code || Envelopes.hasResult(protocol)
            if (!canSay || unsent >= ACKNOWLEDGE_UP_TO) return
            val envelope = Envelopes.response(protocol, System.currentTimeMillis(), code, text)
            // An envelope alone fits into any frame limit worth its name; if not, the robot repeats itself.
            val body = try {
                encoder.prepare(Bodies.write(envelope, Empty.INSTANCE))
            } catch (_: FrameError) {
                return
            }
            send(body, id.answer())
        }
    }

    /** Says what becomes of the connection. */
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

/** How connecting has gone of late. */
internal class Tries(private val backoff: Backoff?) {
    /** Nothing has been attempted yet: there is nothing to wait for. */
    private var isFirst = true

    /** Attempts in a row that did not connect. */
    private var failed = 0

    /** Waits since the robot was last heard. */
    private var waits = 0

    fun failed() {
        failed++
    }

    /** An attempt has connected, and the connection has ended. One that only accepts and closes is waited for longer. */
    fun connected(isHeard: Boolean) {
        isFirst = false
        failed = 0
        if (isHeard) waits = 0
    }

    /** How long to wait before the next attempt; `null` to give up. */
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

/** The watch over the frame that is arriving: a wrong length swallows what follows, and that must not pass for progress. */
internal class FrameWatch(private val limit: Long) {
    private var begun = -1L
    private var last = 0L

    fun whole() {
        begun = -1
    }

    fun came(now: Long) {
        last = now
    }

    /** When a frame of which `received` bytes have come stalls; never in between frames. */
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
        /** What a frame has to bring beside the stall timeout, in bytes per second. */
        const val LEAST = 16 * 1024
    }
}

/** Whether reports that come at intervals come in time. */
internal class Beats(protocol: Protocol) {
    private val intervals = protocol.reports.filter { it.everyMillis > 0 }.associate { it.code to it.everyMillis }
    private val last = HashMap<Int, Long>()

    /** A connection begins; what came over another says nothing about it. */
    fun begin() = last.clear()

    /** A report has come that was not there before: whether it is too long after the last one. */
    fun isLate(code: Int, now: Long): Boolean {
        val every = intervals[code] ?: return false
        val before = last.put(code, now) ?: return false
        return now - before > every + every / 2
    }
}
