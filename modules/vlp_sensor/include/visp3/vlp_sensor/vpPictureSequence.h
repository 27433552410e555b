/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPictureSequence_h
#define vpPictureSequence_h

#include <string>
#include <vector>

#include <visp3/vlp_sensor/vpFrameSource.h>

BEGIN_VISP_NAMESPACE

/*!
  Picture files, one after the other. Pictures without times get their index (0, 1, 2 ...) as time.
*/
class VISP_EXPORT vpPictureSequence : public vpFrameSource
{
public:
  //! These files in this order. They are opened one by one by next(). \throw vpException where there is none.
  explicit vpPictureSequence(const std::vector<std::string> &files);

  /*!
    The files of a pattern with one number in the file's name, as `pictures/frame%04d.png`: from the lowest
    number there is, one by one, up to the first that is missing; remark() tells where there are more. \throw
    vpException where the pattern has anything else than one %d-like conversion, or fits no file.
  */
  static vpPictureSequence fromPattern(const std::string &pattern);

  /*!
    The frames of a recorded or simulated run: `frames.csv` (`timestamp_s,file`, files relative to \e folder),
    in the order of its lines. A time that is not after that of the line above is no error: a recorder that
    hands over a frame late should not cost the run. remark() names the first such line; the caller decides
    whether to use the frame. \throw vpException where the file is missing, malformed (a time that is
    no finite number) or without frames.
  */
  static vpPictureSequence fromRun(const std::string &folder);

  bool next(vpVlpFrame &frame) override;
  size_t size() const override { return m_pictures.size(); }
  std::string remark() const override { return m_remark; }

private:
  struct Picture {
    std::string file;
    double timestamp = 0; // s
  };

  vpPictureSequence() = default;

  std::vector<Picture> m_pictures;
  size_t m_next = 0;
  std::string m_remark;
};

END_VISP_NAMESPACE

#endif
