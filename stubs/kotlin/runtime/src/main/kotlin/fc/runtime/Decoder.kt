package fc.runtime

/** A frame that has arrived, its data decompressed. */
internal class Frame(val id: FrameId, val digest: ByteArray, val encoding: Int, val plainLength: Long, val body: ByteArray)

/**
 * Cuts a stream of bytes into frames.
 *
 * What can be refused is refused as soon as it is known: a wrong head with its first wrong byte, an impossible length
 * before the data has come. Memory grows with what has really arrived.
 */
internal class Decoder(
    private val protocol: Protocol,
    private val limits: Limits,
    private val verifyDigest: Boolean = true,
    private val resync: Boolean = false,
) {
    private val layout = protocol.header
    private val requestHead = protocol.requestHead.toByteArray()
    private val responseHead = protocol.responseHead.toByteArray()
    private var buffer = ByteArray(0)
    private var start = 0
    private var end = 0
    private var failed: FrameError? = null

    /** Bytes have been skipped and no frame has been found since. */
    private var isSearching = false

    /** Bytes of frames that were tried in this search without success. */
    private var tried = 0L

    /** Bytes decompressed beyond those that came, since it was last asked. */
    private var surplus = 0L

    /** Takes note of [surplus]. */
    fun takeSurplus(): Long = surplus.also { surplus = 0 }

    /** Bytes received and not yet given out as frames. */
    val pending: Int get() = end - start

    /** How long the frame claims to be that has begun to arrive; the length of a header while that has not come. */
    val expected: Long
        get() = layout.peekTotal(buffer, start, pending).let { if (it < 0) layout.length.toLong() else it }

    /** Whether the frame that has begun to arrive lacks a part of its header. */
    val isInsideHeader: Boolean get() = pending in 1 until layout.length

    /** Bytes that its buffer takes. */
    val capacity: Long get() = buffer.size.toLong()

    /** Bytes of the larger buffer that pushing so many bytes takes; 0 if they fit into this one. */
    fun growth(length: Int): Long = if (pending + length <= buffer.size) 0 else grown(pending + length).toLong()

    private fun grown(needed: Int): Int = maxOf(needed.toLong(), minOf(2L * buffer.size, limits.frameBytes), 512L).toInt()

    /** About the bytes that handing on the frame at the front takes, with its text and message; 0 if it is not whole. */
    fun cost(): Long {
        val total = layout.peekTotal(buffer, start, pending)
        if (total < layout.length || total > pending) return 0
        val isPacked = layout.peekEncoding(buffer, start) == protocol.gzipEncoding
        val length = if (isPacked) minOf(layout.peekPlain(buffer, start), limits.inflatedBytes) else total
        return if (layout.peekKind(buffer, start) == protocol.streamKind) length else READING * length
    }

    /** Gives back the buffer if it is empty. */
    fun tidy() {
        if (pending == 0) close()
    }

    /** Forgets everything that has come. */
    fun close() {
        start = 0
        end = 0
        buffer = ByteArray(0)
    }

    fun push(bytes: ByteArray, from: Int, length: Int) {
        if (start > 0 && (start == end || end + length > buffer.size)) {
            buffer.copyInto(buffer, 0, start, end)
            end -= start
            start = 0
        }
        if (end + length > buffer.size) {
            buffer = buffer.copyOf(grown(end + length))
        }
        bytes.copyInto(buffer, end, from, from + length)
        end += length
    }

    /**
     * The next whole frame; `null` if it has not arrived yet.
     *
     * @throws FrameError once for each frame that is skipped; again and again if it is fatal
     */
    fun next(): Frame? {
        failed?.let { throw it }
        while (true) {
            val located = try {
                locate()
            } catch (error: FrameError) {
                if (!resync) {
                    failed = error
                    throw error
                }
                search()
                continue
            }
            val (header, length) = located ?: return null
            try {
                val body = check(header, start + layout.length, start + length)
                isSearching = false
                tried = 0
                consume(length)
                return Frame(header.id, header.digest, header.encoding, header.plainLength, body)
            } catch (error: FrameError) {
                if (!isSearching) {
                    consume(length)
                    throw error
                }
                tried += length
                if (tried > SEARCH * limits.frameBytes) throw fatal(FrameErrorKind.BAD_HEAD, NO_HEAD).also { failed = it }
                search()
            }
        }
    }

    /** The error of a stream that ends here; `null` if it may. */
    fun finish(): FrameError? = failed ?: if (pending == 0 || isSearching) {
        null
    } else {
        fatal(FrameErrorKind.TRUNCATED, "the stream ended with $pending bytes of a frame received")
    }

    private fun consume(length: Int) {
        start += length
        if (start == end) {
            start = 0
            end = 0
            if (buffer.size > KEEP) buffer = ByteArray(0)
        }
    }

    /** Header and length of the frame at the front, if all of it is there. Errors are fatal ones. */
    private fun locate(): Pair<Header, Int>? {
        val isRequest = opens(start, requestHead)
        if (!isRequest && !opens(start, responseHead)) throw fatal(FrameErrorKind.BAD_HEAD, NO_HEAD)
        val total = layout.peekTotal(buffer, start, pending)
        if (total < 0) return null
        if (total > limits.frameBytes) {
            throw fatal(FrameErrorKind.FRAME_TOO_LONG, "it has $total bytes; the limit is ${limits.frameBytes}")
        }
        if (total < layout.length) {
            throw fatal(FrameErrorKind.SHORT_FRAME, "it claims $total bytes; its header has ${layout.length}")
        }
        if (pending < total) return null
        return layout.read(buffer, start, !isRequest) to total.toInt()
    }

    /** Checks a whole frame in the order that decides which of several errors it has, and gives its data. */
    private fun check(header: Header, from: Int, to: Int): ByteArray {
        val kind = header.id.kind
        if (kind in protocol.reservedKinds) throw skipped(FrameErrorKind.RESERVED_KIND, header, "nobody may use it yet")
        if (kind != protocol.commandKind && kind != protocol.reportKind && kind != protocol.streamKind) {
            throw skipped(FrameErrorKind.UNKNOWN_KIND, header, "the protocol has no such kind")
        }
        val packed = header.encoding == protocol.gzipEncoding
        if (!packed && header.encoding != protocol.plainEncoding) {
            throw skipped(FrameErrorKind.UNKNOWN_ENCODING, header, "encoding ${header.encoding}")
        }
        val algorithm = layout.algorithm
        if (verifyDigest && algorithm != null && !algorithm.digest(buffer, from, to - from).contentEquals(header.digest)) {
            throw skipped(FrameErrorKind.BAD_DIGEST, header, "it was damaged on its way")
        }
        val plain = header.plainLength
        if (packed) return inflate(header, from, to)
        if (plain != (to - from).toLong() && !(protocol.takesZeroPlainLength && plain == 0L)) throw otherLength(header)
        return buffer.copyOfRange(from, to)
    }

    private fun inflate(header: Header, from: Int, to: Int): ByteArray {
        val plain = header.plainLength
        if (plain > limits.inflatedBytes) {
            val detail = "it inflates to $plain bytes; the limit is ${limits.inflatedBytes}"
            throw skipped(FrameErrorKind.INFLATED_TOO_LONG, header, detail)
        }
        val most = limits.inflateRatio * (to - from)
        if (header.id.kind != protocol.streamKind && plain > Limits.INFLATE_FREE && plain > most) {
            val detail = "it inflates from ${to - from} bytes to $plain; the limit is ${limits.inflateRatio} times as many"
            throw skipped(FrameErrorKind.INFLATES_TOO_MUCH, header, detail)
        }
        return when (val inflated = inflated(buffer, from, to, plain.toInt())) {
            is Inflated.Data -> inflated.bytes.also { surplus += maxOf(0, it.size - (to - from)) }
            Inflated.Damaged -> throw skipped(FrameErrorKind.BAD_GZIP, header, "not one intact gzip member")
            Inflated.OtherLength -> throw otherLength(header)
        }
    }

    private fun otherLength(header: Header) =
        skipped(FrameErrorKind.PLAIN_LENGTH_MISMATCH, header, "the header says ${header.plainLength} bytes")

    private fun skipped(kind: FrameErrorKind, header: Header, detail: String) = FrameError(kind, header.id, detail)

    private fun fatal(kind: FrameErrorKind, detail: String) = FrameError(kind, null, detail)

    /** Gives up the place at the front and goes to the next that may be a head. */
    private fun search() {
        var at = start + 1
        while (at < end && !opens(at, requestHead) && !opens(at, responseHead)) at++
        isSearching = true
        consume(minOf(at, end) - start)
    }

    /** Whether what has come begins like [head] at [at], as far as it goes. */
    private fun opens(at: Int, head: ByteArray): Boolean =
        head.indices.all { at + it >= end || buffer[at + it] == head[it] }

    private companion object {
        /** How many times the longest frame a search may look through without success. */
        const val SEARCH = 4L

        /** A body, its text and its message. */
        const val READING = 3L

        /** Memory that an empty buffer keeps, in bytes. */
        const val KEEP = 64 * 1024
        const val NO_HEAD = "no frame begins here"
    }
}
