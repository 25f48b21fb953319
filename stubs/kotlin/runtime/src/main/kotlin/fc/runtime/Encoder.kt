package fc.runtime

/** A compressed and digested body that can be sent any number of times. */
internal class Prepared(
    private val protocol: Protocol,
    private val encoding: Int,
    private val plainLength: Int,
    private val digest: ByteArray,
    val data: ByteArray,
) {
    /** Returns the header of a frame with this body. */
    fun header(id: FrameId): ByteArray {
        val head = if (id.isResponse) protocol.responseHead else protocol.requestHead
        val header = Header(id, encoding, plainLength.toLong(), digest)
        return protocol.header.write(head.toByteArray(), header, length.toLong())
    }

    /** Length of the complete frame. */
    val length: Int get() = protocol.header.length + data.size

    /** Returns the complete frame. */
    fun frame(id: FrameId): ByteArray {
        val header = header(id)
        return header.copyOf(header.size + data.size).also { data.copyInto(it, header.size) }
    }
}

/** Creates frames from bodies. */
internal class Encoder(private val protocol: Protocol, private val frameBytes: Long, private val gzip: Gzip?) {
    /**
     * Compresses and digests a body.
     *
     * @throws FrameError `frame_too_long`
     */
    fun prepare(body: ByteArray): Prepared {
        val gzipEncoding = protocol.gzipEncoding
        val packed = if (gzip != null && gzipEncoding != null && body.size >= gzip.fromBytes) {
            deflated(body, gzip.level)
        } else {
            null
        }
        val data = packed ?: body
        val total = protocol.header.length.toLong() + data.size
        if (total > frameBytes) {
            throw FrameError(FrameErrorKind.FRAME_TOO_LONG, null, "it would have $total bytes; the limit is $frameBytes")
        }
        val digest = protocol.header.algorithm?.digest(data, 0, data.size) ?: ByteArray(0)
        val encoding = if (packed != null && gzipEncoding != null) gzipEncoding else protocol.plainEncoding
        return Prepared(protocol, encoding, body.size, digest, data)
    }
}
