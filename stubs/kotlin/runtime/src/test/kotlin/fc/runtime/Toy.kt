package fc.runtime

/** The protocol of the tests: the frames of the vectors, and the three operations of the scripts. */
internal object Toy : Protocol() {
    override val name = "toy"
    override val host = "127.0.0.1"
    override val commandPort = 0
    override val dataPort = 0
    override val header = HeaderLayout(
        true,
        listOf(
            HeaderField.of(HeaderRole.HEAD, 2),
            HeaderField.of(HeaderRole.KIND, 1),
            HeaderField.of(HeaderRole.CODE, 2),
            HeaderField.of(HeaderRole.ID, 4),
            HeaderField.of(HeaderRole.ENCODING, 1),
            HeaderField.constant(1, 0),
            HeaderField.of(HeaderRole.TOTAL_LENGTH, 4),
            HeaderField.of(HeaderRole.PLAIN_LENGTH, 4),
            HeaderField.digest(DigestAlgorithm.MD5),
        ),
    )
    override val requestHead = Bytes.of(byteArrayOf(0xFC.toByte(), 0xAA.toByte()))
    override val responseHead = Bytes.of(byteArrayOf(0xEE.toByte(), 0xAA.toByte()))
    override val streamKind = 0
    override val commandKind = 1
    override val reportKind = 3
    override val reservedKinds = setOf(2)
    override val gzipEncoding = 1
    override val takesZeroPlainLength = true
    override val requestEnvelope: MessageType<*> get() = ToyRequest
    override val responseEnvelope: MessageType<*> get() = ToyResponse
    override val results = Results(
        ResultText(0, "good"), ResultText(1, "protocol"), ResultText(2, "timeout"), ResultText(3, "invalid"), ResultText(4, "expired"),
    )
    override val defaults = Defaults(3000, 2000, AckPolicy(2000, 3), Limits(16_777_216, 67_108_864, 64, 64, 64, 64))
    override val commands: List<Command<*, *>> get() = listOf(ECHO, GO)
    override val reports: List<Report<*>> get() = listOf(MOVED, TICK)

    val ECHO = Command("echo", 100, Effect.READ, Echo, EchoReply)
    val GO = Command("go", 200, Effect.MOTION, Go, Done)
    val MOVED = Report("moved", 300, Moved, Empty).state { Stage(it.metres) }
    val TICK = Report("tick", 301, Tick, Empty).cadence(Cadence.Every(1000))

    /** The progress of the journey: 0 starts it, 3 ends it, 9 is a failure. Each number follows the previous one. */
    class Stage(private val metres: Int) : State {
        override val isFinal get() = metres == 3
        override val isError get() = metres == 9

        override fun mayFollow(previous: State): Boolean = previous is Stage && (metres - previous.metres in 0..1 || isError)
    }
}

internal class ToyRequest private constructor(content: Content) : Message(content) {
    override val messageType: MessageType<*> get() = ToyRequest

    companion object : MessageType<ToyRequest>("ToyRequest") {
        private val TIME = optional("time", Types.I64).role(EnvelopeRole.TIME)

        override fun create(content: Content): ToyRequest = ToyRequest(content)
    }
}

internal class ToyResponse private constructor(content: Content) : Message(content) {
    override val messageType: MessageType<*> get() = ToyResponse

    companion object : MessageType<ToyResponse>("ToyResponse") {
        private val RESULT = required("result", Types.I32).role(EnvelopeRole.RESULT_CODE)
        private val SAID = optional("said", Types.STRING).role(EnvelopeRole.RESULT_TEXT)

        override fun create(content: Content): ToyResponse = ToyResponse(content)
    }
}

internal class Echo private constructor(content: Content) : Message(content) {
    override val messageType: MessageType<Echo> get() = Echo
    val text: String get() = get(TEXT)

    companion object : MessageType<Echo>("Echo") {
        private val TEXT = required("text", Types.STRING.length(0, 1_000_000))

        fun of(text: String): Echo = make(arrayOf(text), Extra.NONE)

        override fun create(content: Content): Echo = Echo(content)
    }
}

internal class EchoReply private constructor(content: Content) : Message(content) {
    override val messageType: MessageType<EchoReply> get() = EchoReply
    val text: String? get() = get(TEXT)

    companion object : MessageType<EchoReply>("EchoReply") {
        private val TEXT = optional("text", Types.STRING)

        fun of(text: String): EchoReply = make(arrayOf(text), Extra.NONE)

        override fun create(content: Content): EchoReply = EchoReply(content)
    }
}

internal class Go private constructor(content: Content) : Message(content) {
    override val messageType: MessageType<Go> get() = Go
    val metres: Int get() = get(METRES)

    companion object : MessageType<Go>("Go") {
        private val METRES = required("metres", Types.I32)

        fun of(metres: Int): Go = make(arrayOf(metres), Extra.NONE)

        override fun create(content: Content): Go = Go(content)
    }
}

internal class Done private constructor(content: Content) : Message(content) {
    override val messageType: MessageType<Done> get() = Done

    companion object : MessageType<Done>("Done") {
        fun of(): Done = make(emptyArray(), Extra.NONE)

        override fun create(content: Content): Done = Done(content)
    }
}

internal class Moved private constructor(content: Content) : Message(content) {
    override val messageType: MessageType<Moved> get() = Moved
    val metres: Int get() = get(METRES)

    companion object : MessageType<Moved>("Moved") {
        private val METRES = required("metres", Types.I32)

        fun of(metres: Int): Moved = make(arrayOf(metres), Extra.NONE)

        override fun create(content: Content): Moved = Moved(content)
    }
}

internal class Tick private constructor(content: Content) : Message(content) {
    override val messageType: MessageType<Tick> get() = Tick

    companion object : MessageType<Tick>("Tick") {
        fun of(): Tick = make(emptyArray(), Extra.NONE)

        override fun create(content: Content): Tick = Tick(content)
    }
}
