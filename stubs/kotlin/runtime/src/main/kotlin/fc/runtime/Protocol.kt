package fc.runtime

/**
 * A protocol: every number and key that the runtime needs, and its operations. The generated code defines the one of
 * the spec; the runtime itself contains none.
 */
public abstract class Protocol {
    /** Short name, for logs. */
    public abstract val name: String

    /** Usual address of the robot. */
    public abstract val host: String

    /** TCP port of commands, responses and reports. */
    public abstract val commandPort: Int

    /** TCP port of streams. */
    public abstract val dataPort: Int

    /** The fixed bytes in front of the data. */
    public abstract val header: HeaderLayout

    /** First bytes of a request. */
    public abstract val requestHead: Bytes

    /** First bytes of a response. */
    public abstract val responseHead: Bytes

    /** Kind of a frame of raw bytes. */
    public abstract val streamKind: Int

    /** Kind of a command and of its response. */
    public abstract val commandKind: Int

    /** Kind of a report and of its acknowledgement. */
    public abstract val reportKind: Int

    /** Kinds that the receiver refuses as reserved. */
    public open val reservedKinds: Set<Int> get() = emptySet()

    /** Encoding of uncompressed data; 0 if the header has no encoding. */
    public open val plainEncoding: Int get() = 0

    /** Encoding of data as one gzip member; `null` without compression. */
    public open val gzipEncoding: Int? get() = null

    /** Quirk: accepts a received plain length of 0 on an uncompressed frame. */
    public open val takesZeroPlainLength: Boolean get() = false

    /** Envelope keys of requests and reports. */
    public abstract val requestEnvelope: MessageType<*>

    /** Envelope keys of responses and acknowledgements. */
    public abstract val responseEnvelope: MessageType<*>

    /** The results that the runtime itself responds with. */
    public abstract val results: Results

    /** Default times and limits. */
    public abstract val defaults: Defaults

    /** Every command. */
    public abstract val commands: List<Command<*, *>>

    /** Every report. */
    public abstract val reports: List<Report<*>>

    override fun toString(): String = name
}

/** A result code and its text. */
public class ResultText(
    /** The result code. */
    public val code: Long,
    /** The text for people. */
    public val text: String,
)

/** The results that the runtime itself responds with. */
public class Results(
    /** The call succeeded. */
    public val success: ResultText,
    /** Unknown command, reserved kind, bad digest. */
    public val protocol: ResultText,
    /** The handler did not finish in time. */
    public val timeout: ResultText,
    /** The body cannot be read or breaks a constraint. */
    public val invalid: ResultText,
    /** The message is older than the configured age. */
    public val expired: ResultText,
)

/** Default times and limits. */
public class Defaults @JvmOverloads constructor(
    /** Longest wait of a call for its response, in milliseconds. */
    public val callTimeout: Long,
    /** Longest time of a handler, after which the app gets a timeout, in milliseconds. */
    public val handlerTimeout: Long,
    /** The acknowledgement policy of reports. */
    public val ack: AckPolicy,
    /** Limits of everything that grows with the data from a peer. */
    public val limits: Limits,
    /** Greatest age of a request that is still handled, in milliseconds; `null` for any age. */
    public val maxAge: Long? = null,
) {
    init {
        Settings.long("Defaults.callTimeout", callTimeout, 0, Settings.LONGEST)
        Settings.long("Defaults.handlerTimeout", handlerTimeout, 0, Settings.LONGEST)
        if (maxAge != null) Settings.long("Defaults.maxAge", maxAge, 0, Settings.LONGEST)
    }
}

/** Timeout and retries for the acknowledgement of a report. */
public class AckPolicy(
    /** Wait before the report is sent again, in milliseconds. It is up to an eighth longer, by connection. */
    public val timeout: Long,
    /** Number of times that the report is sent again. */
    public val retries: Int,
) {
    init {
        Settings.long("AckPolicy.timeout", timeout, 0, Settings.LONGEST)
        Settings.integer("AckPolicy.retries", retries, 0)
    }
}

/** Limits of everything that grows with the data from a peer. Each method returns a copy with one limit changed. */
public class Limits private constructor(private val values: LongArray) {
    /** Sets all limits. The spec defines them. */
    public constructor(
        frameBytes: Long,
        inflatedBytes: Long,
        jsonDepth: Int,
        inFlight: Int,
        queuedReports: Int,
        connections: Int,
    ) : this(
        longArrayOf(
            minOf(frameBytes, MOST_BYTES), minOf(inflatedBytes, MOST_BYTES), jsonDepth.toLong(), inFlight.toLong(),
            queuedReports.toLong(), connections.toLong(), INFLATE_RATIO, 1L shl 20, 32L shl 20,
        ),
    )

    init {
        for (index in values.indices) {
            Settings.long("Limits.${NAMES[index]}", values[index], if (index == QUEUED_REPORTS) 0 else 1)
        }
    }

    /** Longest frame, including the header, in bytes. */
    public val frameBytes: Long get() = values[0]

    /** Longest decompressed data, in bytes. */
    public val inflatedBytes: Long get() = values[1]

    /** Deepest nesting of a JSON body. */
    public val jsonDepth: Int get() = values[2].toInt()

    /** Most calls in flight on one connection. */
    public val inFlight: Int get() = values[3].toInt()

    /** Most reports that wait for one connection. */
    public val queuedReports: Int get() = values[4].toInt()

    /** Most connections to one server. */
    public val connections: Int get() = values[5].toInt()

    /** Largest compression ratio of JSON above 1 MiB. */
    public val inflateRatio: Long get() = values[6]

    /** Most keys of objects and items of lists in a JSON body, over all levels. */
    public val jsonValues: Int get() = values[7].toInt()

    /** Most memory for the items of lists in a JSON body, in bytes. */
    public val jsonListBytes: Long get() = values[8]

    /** Sets [Limits.frameBytes]. */
    public fun frameBytes(bytes: Long): Limits = with(0, minOf(bytes, MOST_BYTES))

    /** Sets [Limits.inflatedBytes]. */
    public fun inflatedBytes(bytes: Long): Limits = with(1, minOf(bytes, MOST_BYTES))

    /** Sets [Limits.jsonDepth]. */
    public fun jsonDepth(levels: Int): Limits = with(2, levels.toLong())

    /** Sets [Limits.inFlight]. */
    public fun inFlight(calls: Int): Limits = with(3, calls.toLong())

    /** Sets [Limits.queuedReports]. */
    public fun queuedReports(reports: Int): Limits = with(4, reports.toLong())

    /** Sets [Limits.connections]. */
    public fun connections(connections: Int): Limits = with(5, connections.toLong())

    /** Sets [Limits.inflateRatio]. */
    public fun inflateRatio(ratio: Long): Limits = with(6, ratio)

    /** Sets [Limits.jsonValues]. */
    public fun jsonValues(values: Int): Limits = with(7, values.toLong())

    /** Sets [Limits.jsonListBytes]. */
    public fun jsonListBytes(bytes: Long): Limits = with(8, bytes)

    private fun with(index: Int, value: Long): Limits = Limits(values.copyOf().also { it[index] = value })

    internal fun json(): Allowance = Allowance(jsonDepth, jsonValues, jsonListBytes)

    internal companion object {
        const val INFLATE_RATIO = 256L
        private const val QUEUED_REPORTS = 4
        private val NAMES = listOf(
            "frameBytes", "inflatedBytes", "jsonDepth", "inFlight", "queuedReports", "connections", "inflateRatio", "jsonValues",
            "jsonListBytes",
        )

        /** The compression ratio is not limited up to this length of the data, in bytes. */
        const val INFLATE_FREE = 1L shl 20

        /** The largest array. */
        const val MOST_BYTES = Int.MAX_VALUE.toLong() - 64
    }
}
