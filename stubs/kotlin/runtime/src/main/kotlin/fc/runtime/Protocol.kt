package fc.runtime

/**
 * A protocol: every number and key that the runtime needs, and its operations. The generated part has the one of the
 * spec; this runtime knows none.
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

    /** The fixed bytes in front of the data area. */
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

    /** Kinds that are refused by name. */
    public open val reservedKinds: Set<Int> get() = emptySet()

    /** Encoding of data sent as it is; 0 if the header does not say how data is packed. */
    public open val plainEncoding: Int get() = 0

    /** Encoding of data sent as one gzip member; `null` if nothing is compressed. */
    public open val gzipEncoding: Int? get() = null

    /** Quirk: a received plain length of 0 is accepted on a frame that is not compressed. */
    public open val takesZeroPlainLength: Boolean get() = false

    /** Keys that every request and report has beside its own. */
    public abstract val requestEnvelope: MessageType<*>

    /** Keys that every response and acknowledgement has beside its own. */
    public abstract val responseEnvelope: MessageType<*>

    /** Results that the runtime itself answers with. */
    public abstract val results: Results

    /** Times and limits where the user sets none. */
    public abstract val defaults: Defaults

    /** Every command. */
    public abstract val commands: List<Command<*, *>>

    /** Every report. */
    public abstract val reports: List<Report<*>>

    override fun toString(): String = name
}

/** A result code and the text sent beside it. */
public class ResultText(
    /** Code. */
    public val code: Long,
    /** Text. */
    public val text: String,
)

/** Results that the runtime itself answers with. */
public class Results(
    /** The call did what it should. */
    public val success: ResultText,
    /** Unknown command, reserved kind, bad digest. */
    public val protocol: ResultText,
    /** No answer from the handler in time. */
    public val timeout: ResultText,
    /** A body that does not parse or breaks a constraint. */
    public val invalid: ResultText,
    /** A message older than the configured age. */
    public val expired: ResultText,
)

/** Times and limits where the user sets none. */
public class Defaults @JvmOverloads constructor(
    /** How long a call waits for its response, in milliseconds. */
    public val callTimeout: Long,
    /** How long a handler may take before the app is told, in milliseconds. */
    public val handlerTimeout: Long,
    /** How acknowledgements of reports are awaited. */
    public val ack: AckPolicy,
    /** Bounds of everything that grows with what a peer sends. */
    public val limits: Limits,
    /** Oldest request that is still served, in milliseconds; `null` for any age. */
    public val maxAge: Long? = null,
) {
    init {
        Settings.long("Defaults.callTimeout", callTimeout, 0, Settings.LONGEST)
        Settings.long("Defaults.handlerTimeout", handlerTimeout, 0, Settings.LONGEST)
        if (maxAge != null) Settings.long("Defaults.maxAge", maxAge, 0, Settings.LONGEST)
    }
}

/** How the acknowledgement of a report is awaited. */
public class AckPolicy(
    /** How long to wait before sending the report again, in milliseconds; up to an eighth longer, by connection. */
    public val timeout: Long,
    /** How often to send it again before giving up. */
    public val retries: Int,
) {
    init {
        Settings.long("AckPolicy.timeout", timeout, 0, Settings.LONGEST)
        Settings.integer("AckPolicy.retries", retries, 0)
    }
}

/** Bounds of everything that grows with what a peer sends. Each method gives the same bounds with one changed. */
public class Limits private constructor(private val values: LongArray) {
    /** No bounds but these: the spec has them. */
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

    /** Longest frame, header included, in bytes. */
    public val frameBytes: Long get() = values[0]

    /** Longest data after decompression, in bytes. */
    public val inflatedBytes: Long get() = values[1]

    /** Deepest nesting of a JSON body. */
    public val jsonDepth: Int get() = values[2].toInt()

    /** Calls in flight on one connection. */
    public val inFlight: Int get() = values[3].toInt()

    /** Reports waiting for one connection. */
    public val queuedReports: Int get() = values[4].toInt()

    /** Connections at one server. */
    public val connections: Int get() = values[5].toInt()

    /** Most bytes that one byte of compressed JSON may become, where more than 1 MiB come out. */
    public val inflateRatio: Long get() = values[6]

    /** Most keys of objects and items of lists in a JSON body, those of all levels together. */
    public val jsonValues: Int get() = values[7].toInt()

    /** Most memory for the items of lists that are read from a JSON body, in bytes. */
    public val jsonListBytes: Long get() = values[8]

    /** With another [Limits.frameBytes]. */
    public fun frameBytes(bytes: Long): Limits = with(0, minOf(bytes, MOST_BYTES))

    /** With another [Limits.inflatedBytes]. */
    public fun inflatedBytes(bytes: Long): Limits = with(1, minOf(bytes, MOST_BYTES))

    /** With another [Limits.jsonDepth]. */
    public fun jsonDepth(levels: Int): Limits = with(2, levels.toLong())

    /** With another [Limits.inFlight]. */
    public fun inFlight(calls: Int): Limits = with(3, calls.toLong())

    /** With another [Limits.queuedReports]. */
    public fun queuedReports(reports: Int): Limits = with(4, reports.toLong())

    /** With another [Limits.connections]. */
    public fun connections(connections: Int): Limits = with(5, connections.toLong())

    /** With another [Limits.inflateRatio]. */
    public fun inflateRatio(ratio: Long): Limits = with(6, ratio)

    /** With another [Limits.jsonValues]. */
    public fun jsonValues(values: Int): Limits = with(7, values.toLong())

    /** With another [Limits.jsonListBytes]. */
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

        /** Data of so many bytes or fewer may have been compressed by any ratio. */
        const val INFLATE_FREE = 1L shl 20

        /** An array has no more. */
        const val MOST_BYTES = Int.MAX_VALUE.toLong() - 64
    }
}
