package fc.runtime

import java.io.IOException
import java.nio.ByteBuffer
import java.util.function.Consumer
import javax.net.ssl.SSLContext
import javax.net.ssl.SSLEngine
import javax.net.ssl.SSLEngineResult.HandshakeStatus
import javax.net.ssl.SSLEngineResult.Status
import javax.net.ssl.SSLException
import javax.net.ssl.SSLHandshakeException
import kotlin.concurrent.thread

/** The TLS settings of one side. */
internal class Tls(private val context: SSLContext, private val configure: Consumer<SSLEngine>?) {
    /** Returns an engine for a connection to a robot, whose certificate must name [host]. */
    fun client(host: String, port: Int): SSLEngine = context.createSSLEngine(host, port).apply {
        useClientMode = true
        sslParameters = sslParameters.apply { endpointIdentificationAlgorithm = "HTTPS" }
        configure?.accept(this)
    }

    /** Returns an engine for the connection of an app. */
    fun server(): SSLEngine = context.createSSLEngine().apply {
        useClientMode = false
        configure?.accept(this)
    }
}

/** Connects over TLS. The connection is handed over after its handshake. */
internal class TlsDial(private val loop: Loop, private val dial: Dial, private val engine: () -> SSLEngine) : Dial {
    override fun dial(done: (Link?, Exception?) -> Unit): Timer {
        var secured: TlsLink? = null
        val attempt = dial.dial { link, failure ->
            if (link == null) {
                done(null, failure)
            } else {
                try {
                    val tls = TlsLink(loop, link, engine())
                    secured = tls
                    tls.shakeHands { error -> if (error == null) done(tls, null) else done(null, error) }
                } catch (error: Exception) {
                    link.close()
                    done(null, error)
                }
            }
        }
        return object : Timer {
            override fun cancel() {
                attempt.cancel()
                secured?.close()
            }
        }
    }
}

/**
 * A link over TLS. It continues the handshake whenever it reads or writes. Its buffers take about 70 KiB.
 *
 * @param onFailure called with the reason of a failed handshake
 */
internal class TlsLink(
    private val loop: Loop,
    private val link: Link,
    private val engine: SSLEngine,
    private val onFailure: (IOException) -> Unit = {},
) : Link {
    private var ready: () -> Unit = {}
    private var isOpen = false

    /** `true` while another thread works on the handshake, for example on certificates. */
    private var isWorking = false
    private var hasShaken = false
    private var limit: Timer? = null
    private var failure: IOException? = null

    /** Received records. */
    private var received = ByteBuffer.allocate(engine.session.packetBufferSize + READ)
    private val scratch = ByteArray(READ)

    /** Decrypted bytes to be read. */
    private var plain = empty(engine.session.applicationBufferSize)

    /** Records to be sent. */
    private var out = empty(engine.session.packetBufferSize)
    private var isAtEnd = false
    private var isEnding = false
    private var hasEnded = false
    private var isClosed = false

    init {
        engine.beginHandshake()
    }

    /** Ends the link unless the handshake is complete at a time. */
    fun shakeUntil(at: Long) {
        limit = loop.schedule(at) {
            fail(SSLHandshakeException("the handshake took too long"))
            ready()
        }
    }

    /** Makes the handshake. [done] gets the error of a failed one. */
    fun shakeHands(done: (IOException?) -> Unit) {
        fun step() {
            if (isClosed) return
            try {
                if (attempt { shake() }) return done(null)
                want(read = true, write = false)
            } catch (error: IOException) {
                close()
                done(error)
            }
        }
        open { step() }
        step()
    }

    override fun open(ready: () -> Unit) {
        this.ready = ready
        if (isOpen) return
        isOpen = true
        link.open {
            try {
                attempt { if (flush()) finish() }
            } catch (_: IOException) {
                // The next read or write fails too.
            }
            this.ready()
        }
    }

    override fun read(into: ByteArray): Int = attempt {
        if (!shake()) return@attempt nothing()
        while (!plain.hasRemaining()) {
            if (!unwrap()) return@attempt nothing()
            if (!shake()) return@attempt 0
        }
        val length = minOf(into.size, plain.remaining())
        plain.get(into, 0, length)
        length
    }

    private fun nothing() = if (isAtEnd) -1 else 0

    override fun write(bytes: ByteArray, from: Int, length: Int): Int = attempt {
        if (!shake()) return@attempt 0
        val source = ByteBuffer.wrap(bytes, from, minOf(length, PIECE))
        val whole = source.remaining()
        while (source.hasRemaining()) {
            val before = source.remaining()
            if (!wrap(source) || source.remaining() == before) break
        }
        whole - source.remaining()
    }

    override fun want(read: Boolean, write: Boolean) {
        val hasOut = out.hasRemaining()
        when {
            isWorking -> link.want(read = false, write = hasOut)
            engine.handshakeStatus == HandshakeStatus.NEED_UNWRAP && !isAtEnd -> link.want(read = true, write = hasOut)
            else -> link.want(read, write || hasOut)
        }
    }

    override fun endOutput(): Unit = attempt {
        isEnding = true
        engine.closeOutbound()
        finish()
    }

    override fun close() {
        isClosed = true
        limit?.cancel()
        link.close()
    }

    /** Continues the handshake as far as possible. Returns `true` if nothing is left to do. */
    private fun shake(): Boolean {
        if (isWorking) return false
        while (true) {
            when (engine.handshakeStatus) {
                HandshakeStatus.NEED_TASK -> {
                    work()
                    return false
                }
                HandshakeStatus.NEED_WRAP -> if (!wrap(NOTHING)) return false
                // Decrypted bytes are read first, since there is one buffer for them.
                HandshakeStatus.NEED_UNWRAP -> if (plain.hasRemaining()) return true else if (!unwrap()) return false
                else -> {
                    hasShaken = true
                    limit?.cancel()
                    return true
                }
            }
        }
    }

    /** Lets another thread do the long tasks of the handshake. */
    private fun work() {
        isWorking = true
        val tasks = generateSequence { engine.delegatedTask }.toList()
        thread(isDaemon = true, name = "fc-tls") {
            val error = runCatching { tasks.forEach { it.run() } }.exceptionOrNull()
            loop.execute {
                isWorking = false
                if (error != null) fail(SSLHandshakeException("a task of the handshake failed").apply { initCause(error) })
                if (!isClosed) ready()
            }
        }
    }

    /** Encrypts bytes into one record and sends it. Returns `false` if a part of it is left. */
    private fun wrap(source: ByteBuffer): Boolean {
        if (!flush()) return false
        while (true) {
            out.clear()
            val result = engine.wrap(source, out)
            out.flip()
            if (result.status != Status.BUFFER_OVERFLOW) return flush()
            out = empty(maxOf(2 * out.capacity(), engine.session.packetBufferSize))
        }
    }

    /** Sends waiting records. Returns `true` if none are left. */
    private fun flush(): Boolean {
        while (out.hasRemaining()) {
            val taken = link.write(out.array(), out.position(), out.remaining())
            if (taken == 0) return false
            out.position(out.position() + taken)
        }
        return true
    }

    /** Decrypts the next record. Returns `false` if it has not arrived, and at the end. */
    private fun unwrap(): Boolean {
        while (true) {
            received.flip()
            plain.clear()
            val status = try {
                engine.unwrap(received, plain).status
            } finally {
                received.compact()
                plain.flip()
            }
            when (checkNotNull(status)) {
                Status.OK -> return true
                Status.BUFFER_UNDERFLOW -> if (!receive()) return false
                Status.BUFFER_OVERFLOW -> plain = empty(maxOf(2 * plain.capacity(), engine.session.applicationBufferSize))
                Status.CLOSED -> {
                    isAtEnd = true
                    return false
                }
            }
        }
    }

    private fun receive(): Boolean {
        val length = link.read(scratch)
        if (length < 0) {
            isAtEnd = true
            if (!hasShaken) throw SSLHandshakeException("the peer closed the connection in the handshake")
        }
        if (length <= 0) return false
        if (received.remaining() < length) received = ByteBuffer.allocate(2 * received.capacity()).put(received.apply { flip() })
        received.put(scratch, 0, length)
        return true
    }

    /** Says goodbye and closes the outgoing half, as soon as everything is sent. */
    private fun finish() {
        if (!isEnding || hasEnded) return
        // An alert may precede the goodbye.
        repeat(2) { if (!engine.isOutboundDone && !wrap(NOTHING)) return }
        if (!flush()) return
        hasEnded = true
        link.endOutput()
    }

    /** Runs an operation, unless an earlier one failed. */
    private inline fun <T> attempt(operation: () -> T): T {
        failure?.let { throw it }
        try {
            return operation()
        } catch (error: IOException) {
            if (error is SSLException) sayWhy()
            fail(error)
            throw error
        }
    }

    /** Sends the prepared alert, if the peer takes it at once. */
    private fun sayWhy() {
        try {
            if (engine.handshakeStatus == HandshakeStatus.NEED_WRAP) wrap(NOTHING)
        } catch (_: IOException) {
            // The connection ends in any case.
        }
    }

    private fun fail(error: IOException) {
        if (failure != null) return
        failure = error
        limit?.cancel()
        if (!hasShaken && !isClosed) onFailure(error)
    }

    private companion object {
        val NOTHING: ByteBuffer = ByteBuffer.allocate(0)
        const val READ = 16 * 1024

        /** Most bytes per write, because all other connections wait while they are encrypted. */
        const val PIECE = 64 * 1024

        fun empty(capacity: Int): ByteBuffer = ByteBuffer.allocate(capacity).apply { limit(0) }
    }
}
