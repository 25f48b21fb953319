package fc.runtime

import java.io.IOException
import java.net.InetAddress
import java.net.InetSocketAddress
import java.net.UnknownHostException
import java.nio.ByteBuffer
import java.nio.channels.CancelledKeyException
import java.nio.channels.ClosedChannelException
import java.nio.channels.SelectionKey
import java.nio.channels.Selector
import java.nio.channels.ServerSocketChannel
import java.nio.channels.SocketChannel
import java.util.PriorityQueue
import java.util.concurrent.ConcurrentLinkedQueue
import java.util.concurrent.atomic.AtomicBoolean
import kotlin.concurrent.thread

/** A loop over sockets with its own daemon thread. */
internal class NioLoop(name: String, log: Log? = null) : Loop {
    private val lines = Lines(log, null) { now }

    private val selector = Selector.open()
    private val tasks = ConcurrentLinkedQueue<() -> Unit>()
    private val timers = PriorityQueue<Alarm>()
    private val isAwake = AtomicBoolean(true)
    private var order = 0L

    @Volatile
    private var isEnding = false
    private val worker: Thread = thread(isDaemon = true, name = name) { run() }

    override val now: Long get() = System.nanoTime() / 1_000_000

    /** `true` once the thread has ended. */
    @Volatile
    private var isOver = false

    override fun execute(task: () -> Unit) {
        tasks.add(task)
        // After the end, the task only reports the end, on the thread of the caller.
        if (isOver) return drain()
        if (Thread.currentThread() !== worker && !isAwake.getAndSet(true)) selector.wakeup()
    }

    override fun schedule(at: Long, task: () -> Unit): Timer = Alarm(at, order++, task).also { timers.add(it) }

    private inner class Alarm(val at: Long, val order: Long, var task: (() -> Unit)?) : Timer, Comparable<Alarm> {
        override fun compareTo(other: Alarm): Int = if (at != other.at) at.compareTo(other.at) else order.compareTo(other.order)

        override fun cancel() {
            if (task == null) return
            task = null
            timers.remove(this)
        }
    }

    /** Ends the thread after its tasks. */
    fun end() {
        isEnding = true
        execute {}
    }

    private fun run() {
        while (true) {
            val count = tasks.size
            repeat(count) { tasks.poll()?.let { guarded(it) } }
            generateSequence { if (isDue()) timers.poll() else null }.forEach { alarm -> alarm.task?.let { guarded(it) } }
            if (isEnding && tasks.isEmpty()) break
            // An interrupted thread would close every channel that it uses.
            Thread.interrupted()
            guarded { select() }
        }
        isOver = true
        guarded { selector.close() }
        drain()
    }

    private fun drain(): Unit = synchronized(tasks) { generateSequence { tasks.poll() }.forEach { guarded(it) } }

    private fun isDue(): Boolean = timers.peek()?.let { it.at <= now } ?: false

    private fun select() {
        isAwake.set(false)
        val wait = timers.peek()?.let { (it.at - now).coerceIn(0, IDLE) } ?: IDLE
        try {
            if (tasks.isNotEmpty() || wait == 0L) selector.selectNow() else selector.select(wait)
        } catch (failure: IOException) {
            // Without a pause, it would fail again at once.
            Thread.sleep(PAUSE)
            throw failure
        } finally {
            isAwake.set(true)
        }
        val keys = selector.selectedKeys()
        for (key in keys) {
            @Suppress("UNCHECKED_CAST")
            guarded(key.attachment() as () -> Unit)
        }
        keys.clear()
    }

    /** Runs a task. All connections share the thread, so an exception must not end it. */
    private fun guarded(task: () -> Unit) {
        try {
            task()
        } catch (_: CancelledKeyException) {
            // The connection has ended in the same turn.
        } catch (failure: Throwable) {
            lines.failed("a task of the runtime failed", failure)
        }
    }

    /** Connects to a port. Another thread looks up the name. */
    fun connect(host: String, port: Int, keepalive: Boolean, done: (Link?, Exception?) -> Unit): Timer {
        val attempt = Attempt(keepalive, done)
        try {
            thread(isDaemon = true, name = "fc-lookup") { look(host, port, attempt) }
        } catch (failure: Throwable) {
            // If no thread can start, the attempt fails like any other, after its timer exists.
            execute { attempt.fail(failure) }
        }
        return attempt
    }

    /** On Android, an app without the network permission gets a `SecurityException`. */
    private fun look(host: String, port: Int, attempt: Attempt) = try {
        val address = InetSocketAddress(InetAddress.getByName(host), port)
        execute { attempt.connect(address) }
    } catch (failure: Throwable) {
        execute { attempt.fail(failure) }
    }

    private inner class Attempt(private val keepalive: Boolean, done: (Link?, Exception?) -> Unit) : Timer {
        private var done: ((Link?, Exception?) -> Unit)? = done
        private var channel: SocketChannel? = null

        fun connect(address: InetSocketAddress) {
            if (done == null) return
            try {
                val channel = SocketChannel.open().also { this.channel = it }
                channel.configureBlocking(false)
                if (channel.connect(address)) return connected(channel)
                channel.register(selector, SelectionKey.OP_CONNECT, { finish(channel) })
            } catch (failure: Throwable) {
                fail(failure)
            }
        }

        private fun finish(channel: SocketChannel) {
            try {
                if (channel.finishConnect()) connected(channel)
            } catch (failure: Throwable) {
                fail(failure)
            }
        }

        private fun connected(channel: SocketChannel) {
            val link = link(channel, keepalive)
            this.channel = null
            end(link, null)
        }

        fun fail(failure: Throwable) {
            if (failure !is IOException) lines.failed("an attempt to connect failed", failure)
            channel?.close()
            end(null, failure as? Exception ?: IOException(failure))
        }

        private fun end(link: Link?, failure: Exception?) {
            val told = done
            done = null
            told?.invoke(link, failure)
        }

        override fun cancel() {
            done = null
            channel?.close()
        }
    }

    /** Listens at a port. [accepted] is called for each connection. */
    fun listen(address: InetSocketAddress, accepted: (SocketChannel) -> Unit): ServerSocketChannel {
        if (address.isUnresolved) throw UnknownHostException("no such address: ${address.hostString}")
        val listener = ServerSocketChannel.open()
        try {
            listener.socket().reuseAddress = true
            listener.socket().bind(address, BACKLOG)
            listener.configureBlocking(false)
        } catch (failure: Throwable) {
            listener.close()
            throw failure
        }
        execute { if (listener.isOpen) Listening(listener, accepted).listen() }
        return listener
    }

    private inner class Listening(private val listener: ServerSocketChannel, private val accepted: (SocketChannel) -> Unit) {
        fun listen() {
            listener.register(selector, SelectionKey.OP_ACCEPT, { accept() })
        }

        private fun accept() {
            try {
                while (true) accept(listener.accept() ?: return)
            } catch (_: ClosedChannelException) {
                // The listener is closed.
            } catch (_: IOException) {
                // For example, no file descriptors are left: it would fail again at once.
                val key = listener.keyFor(selector)
                key?.interestOps(0)
                schedule(now + PAUSE) { if (key?.isValid == true) key.interestOps(SelectionKey.OP_ACCEPT) }
            }
        }

        private fun accept(channel: SocketChannel) {
            try {
                accepted(channel)
            } catch (_: IOException) {
                // The peer has disconnected already.
                channel.close()
            } catch (failure: Throwable) {
                channel.close()
                throw failure
            }
        }
    }

    fun link(channel: SocketChannel, keepalive: Boolean): Link {
        channel.configureBlocking(false)
        channel.socket().tcpNoDelay = true
        channel.socket().keepAlive = keepalive
        return NioLink(channel)
    }

    private inner class NioLink(private val channel: SocketChannel) : Link {
        private var key: SelectionKey? = null

        override fun open(ready: () -> Unit) {
            // An operation calls back once. Each turn requests it again.
            key = channel.register(selector, 0, {
                key?.takeIf { it.isValid }?.interestOps(0)
                ready()
            })
        }

        override fun read(into: ByteArray): Int = channel.read(ByteBuffer.wrap(into))

        override fun write(bytes: ByteArray, from: Int, length: Int): Int =
            channel.write(ByteBuffer.wrap(bytes, from, minOf(length, PIECE)))

        override fun want(read: Boolean, write: Boolean) {
            val wanted = (if (read) SelectionKey.OP_READ else 0) or (if (write) SelectionKey.OP_WRITE else 0)
            key?.takeIf { it.isValid }?.interestOps(wanted)
        }

        override fun endOutput() {
            channel.socket().shutdownOutput()
        }

        override fun close() {
            try {
                channel.close()
            } catch (_: IOException) {
                // The socket is closed in any case.
            }
        }
    }

    private companion object {
        const val IDLE = 60_000L
        const val BACKLOG = 128

        /** Pause of accepting after a failure, in milliseconds. */
        const val PAUSE = 100L

        /** Most bytes per write, because the system copies them while all other connections wait. */
        const val PIECE = 256 * 1024
    }
}
