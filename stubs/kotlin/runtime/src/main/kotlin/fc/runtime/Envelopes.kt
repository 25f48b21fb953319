package fc.runtime

/** The keys that every request and response has beside its own. */
internal object Envelopes {
    fun request(protocol: Protocol, timeMs: Long): Message = make(protocol.requestEnvelope) { role ->
        if (role == EnvelopeRole.TIME) timeMs else null
    }

    fun response(protocol: Protocol, timeMs: Long, code: Long, text: String): Message = make(protocol.responseEnvelope) { role ->
        when (role) {
            EnvelopeRole.TIME -> timeMs
            EnvelopeRole.RESULT_CODE -> code
            EnvelopeRole.RESULT_TEXT -> text
        }
    }

    private fun make(type: MessageType<*>, value: (EnvelopeRole) -> Any?): Message {
        val values = Array<Any?>(type.fields.size) { index ->
            val field = type.fields[index]
            val made = field.role?.let(value)
            if (made is Long) field.codec.nearest(made) else made
        }
        return type.make(values, Extra.NONE)
    }

    /** Whether responses carry a result code. If not, what did not go well is not answered. */
    fun hasResult(protocol: Protocol): Boolean = protocol.responseEnvelope.roleField(EnvelopeRole.RESULT_CODE) != null

    /** Returns `true` if a result code is a value of its field. Without such a field, none is sent. */
    fun carries(protocol: Protocol, code: Long): Boolean {
        val field = protocol.responseEnvelope.roleField(EnvelopeRole.RESULT_CODE) ?: return true
        return (field.codec.nearest(code) as? Number)?.toLong() == code
    }

    /** The result code of a response; `null` if it has none. */
    fun resultCode(protocol: Protocol, envelope: Message): Long? =
        (value(protocol.responseEnvelope, envelope, EnvelopeRole.RESULT_CODE) as Number?)?.toLong()

    /** What a response says has gone wrong, if it says so. */
    fun refusal(protocol: Protocol, envelope: Message): Refusal? {
        val code = resultCode(protocol, envelope) ?: return null
        if (code == protocol.results.success.code) return null
        val text = value(protocol.responseEnvelope, envelope, EnvelopeRole.RESULT_TEXT) as String?
        return Refusal(code, text ?: "")
    }

    /** When a message was made, if it says so. */
    fun time(type: MessageType<*>, envelope: Message): Long? = (value(type, envelope, EnvelopeRole.TIME) as Number?)?.toLong()

    private fun value(type: MessageType<*>, envelope: Message, role: EnvelopeRole): Any? =
        type.roleField(role)?.let { envelope.values[it.index] }
}
