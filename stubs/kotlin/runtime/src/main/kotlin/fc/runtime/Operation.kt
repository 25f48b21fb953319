package fc.runtime

/** What a command does to the robot. */
public enum class Effect {
    /** Only asks. */
    READ,

    /** Changes what the robot knows or how it behaves. */
    CONFIG,

    /** Sets something in motion. */
    MOTION,

    /** Nobody knows: never repeated by itself, like what sets something in motion. */
    UNKNOWN,
}

/** A command: a request with a code, tied to its response. The generated part has one value for each. */
public class Command<Q : Message, A : Message>(
    /** Name in the spec. */
    public val name: String,
    /** Command code. */
    public val code: Int,
    /** What it does to the robot. */
    public val effect: Effect,
    /** Its request. */
    public val request: MessageType<Q>,
    /** Its response. */
    public val response: MessageType<A>,
) {
    internal var declared: List<DeclaredError> = emptyList()

    /** What people call it, in Chinese. */
    public var titleZh: String = name
        private set

    /** What people call it, in English. */
    public var titleEn: String = name
        private set

    /** With what people call it. */
    public fun titled(zh: String, en: String): Command<Q, A> = apply {
        titleZh = zh
        titleEn = en
    }

    /** With the results besides success that it declares. */
    public fun declares(vararg errors: DeclaredError): Command<Q, A> = apply { declared = errors.toList() }

    private var states: List<Any> = emptyList()

    /** Accepted only in these states, of whichever enums. */
    public fun accepted(vararg states: Any): Command<Q, A> = apply { this.states = states.toList() }

    /**
     * Whether it is accepted in this state, as far as it depends on states of this enum. One that the spec does not know is none
     * of them.
     */
    public fun isAcceptedIn(state: Any): Boolean = states.none { it.javaClass == state.javaClass } || state in states

    override fun toString(): String = name
}

/** A result besides success that a command declares, by name. */
public open class DeclaredError(
    /** Its name in the spec. */
    public val name: String,
    /** Its result code. */
    public val code: Long,
    /** The text sent beside it. */
    public val text: String,
) {
    /** The refusal of a handler. */
    public fun refusal(): Refusal = Refusal(code, text)

    override fun toString(): String = name
}

/** A report: a message that is pushed and acknowledged. The generated part has one value for each. */
public class Report<R : Message>(
    /** Name in the spec. */
    public val name: String,
    /** Command code. */
    public val code: Int,
    /** Its message. */
    public val message: MessageType<R>,
    /** What it is acknowledged with. */
    public val acknowledgement: MessageType<*>,
) {
    /** What people call it, in Chinese. */
    public var titleZh: String = name
        private set

    /** What people call it, in English. */
    public var titleEn: String = name
        private set

    /** With what people call it. */
    public fun titled(zh: String, en: String): Report<R> = apply {
        titleZh = zh
        titleEn = en
    }

    internal var ack: AckPolicy? = null
    internal var everyMillis: Long = 0
    internal var stateOf: ((R) -> State?)? = null
    internal var failureOf: ((R) -> Boolean)? = null

    /** With another way to await its acknowledgement than the protocol's. */
    public fun ack(ack: AckPolicy): Report<R> = apply { this.ack = ack }

    /** It comes at intervals of so many milliseconds. */
    public fun every(milliseconds: Long): Report<R> = apply { everyMillis = milliseconds }

    /** What says how far the process has come; `null` if such a report does not say. */
    public fun state(state: (R) -> State?): Report<R> = apply { stateOf = state }

    /** What says that something failed, where it is not the state. */
    public fun failure(failure: (R) -> Boolean): Report<R> = apply { failureOf = failure }

    internal fun stateIn(report: R): State? = stateOf?.invoke(report)

    internal fun isFailure(report: R): Boolean = failureOf?.invoke(report) ?: (stateIn(report)?.isError == true)

    override fun toString(): String = name
}

/** A refusal: the result code and text that a handler answers with, or that a robot has answered with. */
public class Refusal(
    /** Result code; not the one of success. */
    public val code: Long,
    /** Text for people. Never rely on it. */
    public val text: String,
) : Exception(null, null, false, false) {
    override val message: String get() = "refused with result $code: $text"

    override fun equals(other: Any?): Boolean = other is Refusal && other.code == code && other.text == text

    override fun hashCode(): Int = code.hashCode()
}
