package fc.runtime

/** The envelope keys of requests and responses. */
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

    /** Returns `true` if responses carry a result code. Otherwise failures get no response. */
    fun hasResult(protocol: Protocol): Boolean = protocol.responseEnvelope.roleField(EnvelopeRole.RESULT_CODE) != null

    /** Returns `true` if the field of the result code accepts a code. Without such a field, none is sent. */
    fun carries(protocol: Protocol, code: Long): Boolean {
        val field = protocol.responseEnvelope.roleField(EnvelopeRole.RESULT_CODE) ?: return true
        return (field.codec.nearest(code) as? Number)?.toLong() == code
    }

    /** Returns the result code of a response, or `null` if it has none. */
    fun resultCode(protocol: Protocol, envelope: Message): Long? =
        (value(protocol.responseEnvelope, envelope, EnvelopeRole.RESULT_CODE) as Number?)?.toLong()

    /** Returns the refusal in a response, if any. */
    fun refusal(protocol: Protocol, envelope: Message): Refusal? {
        val code = resultCode(protocol, envelope) ?: return null
        if (code == protocol.results.success.code) return null
        val text = value(protocol.responseEnvelope, envelope, EnvelopeRole.RESULT_TEXT) as String?
        return Refusal(code, text ?: "")
    }

    /** Returns the creation time of a message, if its envelope has one. */
    fun time(type: MessageType<*>, envelope: Message): Long? = (value(type, envelope, EnvelopeRole.TIME) as Number?)?.toLong()

    private fun value(type: MessageType<*>, envelope: Message, role: EnvelopeRole): Any? =
        type.roleField(role)?.let { envelope.values[it.index] }
}
